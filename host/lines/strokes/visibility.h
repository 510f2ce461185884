#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/imaging/camera.h"
#include "host/lines/strokes/chains.h"
#include "host/lines/extraction/lines.h"
#include "host/mesh/queries/rays.h"

namespace exemplar {

/// A part of a segment: from its first end (0) to its second (1), from < to.
struct VisiblePart {
    float from = 0, to = 1;
};

/// The visible parts of segments, in order along each.
struct VisibleParts {
    std::vector<std::uint32_t> begin{0};  ///< of segment s: parts [begin[s], begin[s + 1])
    std::vector<VisiblePart> parts;
    std::vector<float> pixels;  ///< length of each segment in the picture; zero if it passes the eye

    std::size_t segment_count() const { return begin.size() - 1; }
    std::span<const VisiblePart> of(std::size_t segment) const {
        return {parts.data() + begin[segment], parts.data() + begin[segment + 1]};
    }
};

struct VisibilityOptions {
    float spacing = 1;  ///< pixels between the points that are tested; positive
    /// Pixels around the image that lines are followed into, so that what happens at their ends does not show.
    float margin = 32;
};

/// Makes visible what is hidden for at most `most_pixels` between two visible parts of a chain: on uneven meshes the
/// own surface of a line may hide bits of it. Throws UsageError if chains and parts are not of the same segments.
void close_gaps(std::span<const Chain> chains, float most_pixels, VisibleParts& visible);

/// Tells which parts of lines on a surface an eye sees, by rays to it: the exact counterpart of tests against a picture
/// of depths. Keeps an index of the surface. The surface must live as long; queries are thread-safe.
class LineVisibility {
  public:
    /// Throws UsageError if the surface has not as many normals as vertices, MeshError as build_face_neighbors.
    explicit LineVisibility(const LineSurface& surface);

    /// The visible parts of lines of a type, in a picture of so many pixels: inside the camera's depth range, inside
    /// the image (or its margin), and with nothing in front. Changes of visibility are found to a twentieth of a pixel;
    /// what is shorter than the spacing may be missed. Runs on all cores; the result does not depend on their number.
    ///
    /// A contour is where smooth normals say that the surface turns away, which is up to about an edge behind the
    /// outline of the polygons, so a ray from it may first leave the surface through faces nearby. They do not hide it:
    /// faces that touch one that touches its face, and nearer than three times its longest edge, if the contour is of
    /// the kind that is not hidden by its own surface (radial curvature is positive; without curvature, n.w grows
    /// towards the eye) or on an open surface, which may be seen from behind. Nor do they hide other lines where the
    /// normals face the eye and the face does not. Creases and boundaries lie on the polygons themselves, so nothing is
    /// overlooked for them.
    VisibleParts visible_parts(LineType type, std::span<const LineSegment> segments, const Camera& camera, int width,
                               int height, const VisibilityOptions& options = {}) const;

  private:
    class Query;
    bool touch(std::uint32_t face, std::uint32_t other) const;
    bool are_near(std::uint32_t face, std::uint32_t other) const;
    std::span<const std::uint32_t> faces_at(std::uint32_t vertex) const {
        return {vertex_faces_.data() + vertex_begin_[vertex], vertex_faces_.data() + vertex_begin_[vertex + 1]};
    }

    LineSurface surface_;
    RayScene rays_;
    std::vector<std::uint32_t> vertex_begin_, vertex_faces_;  // the faces at each vertex
    std::vector<std::uint8_t> closed_;                        // of each face: its component has no boundary
    float rounding_ = 0;                                      // of positions, in mesh units
};

}  // namespace exemplar
