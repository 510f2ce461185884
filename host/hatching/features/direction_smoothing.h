#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Completes fields of tangent directions without sign where they are not defined (thesis App. B.3, after Hertzmann and
/// Zorin 2000): the field that changes least over the surface among those that follow the reliable directions.
/// Directions are angles in vertex frames, doubled, as in Knoeppel et al. 2013, so that the best field is a linear
/// system.
class DirectionSmoother {
  public:
    /// `normals`: unit, per vertex. Keeps no reference.
    DirectionSmoother(const TriangleMesh& mesh, std::span<const Vec3> normals);
    ~DirectionSmoother();

    /// The completed field: V unit tangent vectors (zero where no reliable direction can be reached). `directions`: V
    /// vectors, any length, laid into the tangent plane; zero: none. `confidence`: V values in [0, 1]; at 1 a direction
    /// stays, at 0 it does not count, at 1/2 it counts as much as all its neighbors. Safe to call from many threads.
    std::vector<Vec3> complete(std::span<const Vec3> directions, std::span<const float> confidence) const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace exemplar
