#pragma once

#include <optional>
#include <span>
#include <vector>

#include "host/animation/animation.h"
#include "host/lines/extraction/split_surface.h"

namespace exemplar {

/// An animated surface cut open along the sharp edges of one of its shapes, so that the device draws lines of it as
/// the host does (DrawableSurface).
class CutAnimation {
  public:
    /// `first`: the shape whose edges decide, with the faces of the animation, which must outlive this. Edges are only
    /// marked as sharp, but not cut, if `cut` is false.
    CutAnimation(const Animation& animation, const TriangleMesh& first, float crease_angle, bool cut);

    /// The first shape, the rig and the rest shape after cutting; without clips.
    const TriangleMesh& first() const { return first_; }
    const Animation& animation() const { return animation_; }
    /// Neighbors of the faces, with sharp edges marked, and the faces before they were cut apart.
    std::span<const FaceNeighbors> neighbors() const { return neighbors_; }
    std::span<const Face> joined_faces() const { return joined_faces_; }
    /// Returns a shape of the animation after cutting. It is valid until the next call, as long as the other.
    SurfaceShape shape(const SurfaceShape& shape);

  private:
    std::vector<Face> joined_faces_;
    std::vector<FaceNeighbors> neighbors_;
    std::optional<SplitSurface> split_;  // if anything is cut
    TriangleMesh first_;
    Animation animation_;
    std::vector<Vec3> vertices_;
};

}  // namespace exemplar
