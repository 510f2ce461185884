#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/vertex_neighbors.h"

namespace exemplar {

/// Whether a flood reaches a vertex; one in the margin is reached, but does not count.
enum class Nearness { outside, margin, inside };

/// Floods a surface from one vertex after another, over vertices that are near.
///
/// A ball of the usual size may hold a large part of all vertices: where a part of the mesh is much finer than the
/// rest, and where a vertex has very many neighbors. So that the work stays proportional to the mesh, a flood ends with
/// the ring in which it has counted enough vertices, and does not pass over vertices with more neighbors than that.
class NearFlood {
  public:
    /// `enough`: number of vertices after which a flood ends. Neighbors must outlive this.
    NearFlood(const VertexNeighbors& neighbors, std::size_t enough)
        : neighbors_(&neighbors), enough_(enough), seen_(neighbors.vertex_count(), 0) {}

    /// Returns the vertices around `center` ring by ring, without itself; valid until the next call. `nearness` is
    /// called once for each vertex that the flood comes to.
    template <typename NearnessOf>
    std::span<const std::uint32_t> around(std::uint32_t center, NearnessOf&& nearness);

  private:
    // A ring itself may be too long only where vertices of many neighbors follow each other.
    static constexpr std::size_t k_most_in_last_ring = 4;
    void start(std::uint32_t center);
    const VertexNeighbors* neighbors_;
    std::size_t enough_;
    std::vector<std::uint32_t> seen_, reached_;
    std::uint32_t run_ = 0;
};

/// Returns how many vertices are enough for a kernel of this width, given in median edge lengths: 16 times as many as
/// it covers on an even mesh, and at least 64.
inline std::size_t enough_near_vertices(double width) {
    // By a kernel of width 1: its circle (TensorDiffusion) has an area of 30, a vertex one of 0.87.
    constexpr double k_covered = 34.6;
    return static_cast<std::size_t>(std::clamp(16 * k_covered * width * width, 64.0, 1e9));
}

inline void NearFlood::start(std::uint32_t center) {
    if (++run_ == 0) {
        std::fill(seen_.begin(), seen_.end(), 0u);
        run_ = 1;
    }
    seen_[center] = run_;
    reached_.assign(1, center);
}

template <typename NearnessOf>
std::span<const std::uint32_t> NearFlood::around(std::uint32_t center, NearnessOf&& nearness) {
    start(center);
    std::size_t counted = 0, ring_end = 1;
    for (std::size_t next = 0; next < reached_.size(); ++next) {
        if (next == ring_end) {
            if (counted >= enough_) break;
            ring_end = reached_.size();
        }
        const std::span<const std::uint32_t> others = neighbors_->of(reached_[next]);
        if (next > 0 && (others.size() > enough_ || counted >= k_most_in_last_ring * enough_)) continue;
        for (const std::uint32_t v : others) {
            if (seen_[v] == run_) continue;
            seen_[v] = run_;
            const Nearness near = nearness(v);
            if (near == Nearness::outside) continue;
            reached_.push_back(v);
            counted += near == Nearness::inside;
        }
    }
    return std::span(reached_).subspan(1);
}

}  // namespace exemplar
