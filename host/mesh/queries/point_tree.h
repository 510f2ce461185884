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

    /// The index of the nearest point; there must be one.
    std::uint32_t nearest(const Vec3& point) const;
    /// Fills `found` with the indices of the nearest points, nearest first; returns their number, less than
    /// found.size() only where there are fewer points.
    std::size_t nearest(const Vec3& point, std::span<std::uint32_t> found) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace exemplar
