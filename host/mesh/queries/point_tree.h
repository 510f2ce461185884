#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Finds the nearest of many points (a k-d tree, nanoflann). Queries are thread-safe.
class PointTree {
  public:
    explicit PointTree(std::vector<Vec3> points);
    ~PointTree();
    PointTree(PointTree&&) noexcept;
    PointTree& operator=(PointTree&&) noexcept;

    /// Returns the index of the nearest point; there must be a point.
    std::uint32_t nearest(const Vec3& point) const;
    /// Fills `found` with the indices of the nearest points, nearest first. Returns their number, which is below
    /// found.size() only if there are fewer points.
    std::size_t nearest(const Vec3& point, std::span<std::uint32_t> found) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace exemplar
