#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Completes fields of unsigned tangent directions where they are undefined (thesis App. B.3, after Hertzmann and
/// Zorin 2000): finds the smoothest field on the surface that follows the reliable directions. Directions are
/// represented by doubled angles in vertex frames, as in Knoeppel et al. 2013, so that the best field solves a
/// linear system.
class DirectionSmoother {
  public:
    /// `normals`: unit, per vertex. Keeps no reference.
    DirectionSmoother(const TriangleMesh& mesh, std::span<const Vec3> normals);
    ~DirectionSmoother();

    /// Returns the completed field: V unit tangent vectors, zero where no reliable direction can be reached.
    /// `directions`: V vectors of any length, which are projected into the tangent plane; zero: none. `confidence`:
    /// V values in [0, 1]: at 1 a direction stays, at 0 it is ignored, at 1/2 it weighs as much as all its
    /// neighbors. Safe to call from many threads.
    std::vector<Vec3> complete(std::span<const Vec3> directions, std::span<const float> confidence) const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace exemplar
