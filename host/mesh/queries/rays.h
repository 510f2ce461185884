#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Ray casting against a mesh (Embree 3). Queries are thread-safe.
class RayScene {
  public:
    explicit RayScene(const TriangleMesh& mesh);
    ~RayScene();
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;

    struct Hit {
        float distance;  ///< in mesh units along the unit direction
        std::uint32_t face;
    };
    /// Returns the first intersection at a distance >= near; `direction` is a unit vector.
    std::optional<Hit> first_hit(const Vec3& origin, const Vec3& direction, float near) const;
    /// Returns the first hit of a ray that starts on face `from` (any point of it), except with that face. Hits
    /// nearer than the rounding error of the largest coordinate (say, with an exact copy of the face) are ignored,
    /// too.
    std::optional<Hit> first_hit_from(std::uint32_t from, const Vec3& origin, const Vec3& direction) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace exemplar
