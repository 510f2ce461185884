#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "host/synth/modeling/primitives.h"

namespace exemplar {

/// A solid placed in the world: local = (axes^T (p - origin)) / stretch.
struct Primitive {
    Solid solid;
    std::int32_t part = 0;
    Vec3 origin = Vec3::Zero();
    Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< columns: the local axes in the world
    Vec3 stretch = Vec3::Ones();                         ///< > 0; flattens or widens along the local axes
    float blend = 0.02f;                                 ///< width over which it blends into earlier primitives
};

/// The smooth union of primitives as an implicit surface: negative inside, about the distance near the surface.
class ImplicitField {
  public:
    explicit ImplicitField(std::vector<Primitive> primitives);

    float value(const Vec3& p) const;
    /// Returns the value where only the `active` primitives (increasing indices) can matter.
    float value(const Vec3& p, std::span<const std::uint32_t> active) const;
    /// Returns the unit gradient by central differences on a tetrahedron with this step; zero where it vanishes.
    Vec3 normal(const Vec3& p, float step) const;
    /// Moves p onto the surface by Newton steps along the gradient, at most `reach` away. Returns the unit normal
    /// there.
    Vec3 project(Vec3& p, float reach) const;
    /// Returns those of the `active` primitives that can change the value somewhere within `radius` of p.
    std::vector<std::uint32_t> active_near(const Vec3& p, float radius, std::span<const std::uint32_t> active) const;
    /// Returns the part whose own surface is nearest (or that p is deepest inside of).
    std::int32_t dominant_part(const Vec3& p) const;

    std::size_t size() const { return primitives_.size(); }
    const Vec3& low() const { return low_; }  ///< corners of the surface's bounding box
    const Vec3& high() const { return high_; }

  private:
    float distance_to(std::size_t i, const Vec3& p) const;

    std::vector<Primitive> primitives_;
    std::vector<Ball> balls_;
    float largest_blend_ = 0;
    Vec3 low_, high_;
};

}  // namespace exemplar
