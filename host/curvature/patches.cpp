#include "host/curvature/patches.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "host/mesh/topology.h"

namespace exemplar {

namespace {

constexpr float k_far = std::numeric_limits<float>::infinity();

/// Grows patches from seeds, each vertex to the seed nearest over edges.
class PatchGrower {
  public:
    explicit PatchGrower(const TriangleMesh& mesh)
        : neighbors_(mesh.vertex_count()), distance_(mesh.vertex_count(), k_far), patch_(mesh.vertex_count(), 0) {
        for (const Edge& edge : build_topology(mesh).edges) {
            const auto [a, b] = edge.vertex;
            const float length = (mesh.vertices[a] - mesh.vertices[b]).norm();
            neighbors_[a].push_back({b, length});
            neighbors_[b].push_back({a, length});
        }
    }

    void add_seed(std::uint32_t seed) {
        const std::uint32_t patch = patches_++;
        using Reached = std::pair<float, std::uint32_t>;
        std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
        const auto reach = [&](std::uint32_t v, float distance) {
            if (!(distance < distance_[v])) return;
            distance_[v] = distance;
            patch_[v] = patch;
            queue.emplace(distance, v);
        };
        reach(seed, 0);
        while (!queue.empty()) {
            const auto [distance, v] = queue.top();
            queue.pop();
            if (distance > distance_[v]) continue;
            for (const auto& [w, length] : neighbors_[v]) reach(w, distance + length);
        }
    }

    std::uint32_t farthest() const {
        return static_cast<std::uint32_t>(std::max_element(distance_.begin(), distance_.end()) - distance_.begin());
    }
    const std::vector<std::uint32_t>& patches() const { return patch_; }

  private:
    struct Neighbor {
        std::uint32_t vertex;
        float length;
    };
    std::vector<std::vector<Neighbor>> neighbors_;
    std::vector<float> distance_;
    std::vector<std::uint32_t> patch_;
    std::uint32_t patches_ = 0;
};

}  // namespace

std::vector<std::uint32_t> surface_patches(const TriangleMesh& mesh, std::size_t vertices) {
    if (vertices == 0 || mesh.vertex_count() == 0) return std::vector<std::uint32_t>(mesh.vertex_count(), 0);
    const std::size_t count = std::max<std::size_t>(1, mesh.vertex_count() / vertices);
    PatchGrower grower(mesh);
    grower.add_seed(0);
    for (std::size_t i = 1; i < count; ++i) grower.add_seed(grower.farthest());
    return grower.patches();
}

}  // namespace exemplar
