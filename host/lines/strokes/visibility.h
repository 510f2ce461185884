#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/imaging/camera.h"
#include "host/lines/extraction/lines.h"
#include "host/lines/strokes/chains.h"
#include "host/mesh/queries/rays.h"

namespace exemplar {

/// A visible part of a segment, from its first end (0) to its second (1); from < to.
struct VisiblePart {
    float from = 0, to = 1;
};

/// The visible parts of segments, in order along each.
struct VisibleParts {
    std::vector<std::uint32_t> begin{0};  ///< segment s has parts [begin[s], begin[s + 1])
    std::vector<VisiblePart> parts;
    std::vector<float> pixels;  ///< per segment: length in the picture; zero if it reaches behind the eye

    std::size_t segment_count() const { return begin.size() - 1; }
    std::span<const VisiblePart> of(std::size_t segment) const {
        return {parts.data() + begin[segment], parts.data() + begin[segment + 1]};
    }
};

struct VisibilityOptions {
    float spacing = 1;  ///< pixels between tested points; positive
    /// Pixels around the image in which lines still count as visible, so that their ends there do not show.
    float margin = 32;
};

/// Makes hidden gaps of at most `max_pixels` between two visible parts of a chain visible, since on uneven meshes
/// the surface of a line may hide bits of it. Throws UsageError if chains and parts are not of the same segments.
void close_gaps(std::span<const Chain> chains, float max_pixels, VisibleParts& visible);

/// Computes the visible parts of lines on a surface by rays to the eye; exact, unlike tests against a depth buffer.
/// Keeps an index of the surface, which must outlive it. Queries are thread-safe.
class LineVisibility {
  public:
    /// Throws UsageError if the numbers of normals and vertices differ, MeshError as build_face_neighbors does.
    explicit LineVisibility(const LineSurface& surface);

    /// Returns the visible parts of lines of a type in a picture of this size: inside the camera's depth range and
    /// the image (or its margin), and with nothing in front. Changes of visibility are found to 1/20 pixel; parts
    /// shorter than the spacing may be missed. Parallel, with a result independent of the number of threads.
    ///
    /// A contour of smooth normals lies up to about an edge behind the outline of the polygons, so a ray from it may
    /// leave the surface through nearby faces: those within three times the longest edge of the line's face (less
    /// beside a line along a long face) that touch a face touching it. They do not hide, and nor does what is behind
    /// them (the inner side of a thin shell, say), a contour with positive radial curvature (without curvature, and at
    /// sharp edges: where n.w grows towards the eye), which its own surface does not hide, nor one on an open surface,
    /// which may be seen from behind. Nor do they hide other lines where the normals face the eye and the face does
    /// not. A line along an edge lies on the polygons themselves. It is visible where one of the faces at it is, close
    /// to the edge, and no nearby face is ignored, unless it is a contour on a convex edge whose faces both turn away
    /// already where smooth normals do not yet.
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
