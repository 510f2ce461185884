#pragma once

#include <array>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Curvature of a fitted patch at its origin. A sphere of radius r with outward normals has k1 = k2 = 1 / r.
struct PatchCurvature {
    float k1 = 0.0F, k2 = 0.0F;    ///< principal curvatures, k1 >= k2
    float dk1 = 0.0F, dk2 = 0.0F;  ///< |derivative| of k1 along its direction and of k2 along its direction
};

/// Least-squares fit of the height field h = a/2 x^2 + b xy + c/2 y^2 + d x^3 + e x^2 y + f x y^2 + g y^3 over the
/// tangent plane at a point, from positions and normals (Goldfeather & Interrante 2004). Samples can be added after
/// solving, so that growing neighborhoods share their sums.
class CubicPatch {
  public:
    /// `normal` is a unit vector; `unit` is a length of the order of the patch's radius (it conditions the sums).
    CubicPatch(const Vec3& origin, const Vec3& normal, float unit);
    /// Adds a surface point. Ignores points whose normal deviates from the patch's by more than 84 degrees: no height
    /// field passes there.
    void add(const Vec3& position, const Vec3& normal, float weight);
    /// Solves for the curvature; zeros if nothing was added.
    PatchCurvature solve() const;

  private:
    static constexpr std::size_t k_width = 8;  ///< 7 unknowns and the right-hand side
    void add_row(const std::array<double, k_width>& row, double weight);
    Vec3 origin_, x_, y_, z_;
    float unit_;
    std::array<double, k_width * k_width> sums_{};  ///< weighted sums of row^T row
};

}  // namespace exemplar
