#include "host/parts/prototype/level_surface.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "host/core/interrupt.h"

namespace exemplar {
namespace {

/// The corners of a cube, by the bits x, y, z of their number, of six tetrahedra of positive orientation.
constexpr std::array<std::array<std::uint32_t, 4>, 6> k_cube_tetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};
/// Vertices stay this far from the nodes, as a share of the edge, so that no triangle vanishes.
constexpr float k_node_margin = 0.05F;

class LevelTriangles {
  public:
    explicit LevelTriangles(const ValueGrid& grid) : grid_(grid) {}

    void add_cube(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        bool any_inside = false, any_outside = false;
        for (std::uint32_t c = 0; c < 8; ++c) {
            corner_[c] = {x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)};
            node_[c] = grid_.index(corner_[c][0], corner_[c][1], corner_[c][2]);
            (grid_.value[node_[c]] < 0 ? any_inside : any_outside) = true;
        }
        if (!any_inside || !any_outside) return;
        for (const auto& tetrahedron : k_cube_tetrahedra) add_tetrahedron(tetrahedron);
    }

    TriangleMesh finish() {
        mesh_.source_face_count = static_cast<std::uint32_t>(mesh_.faces.size());
        return std::move(mesh_);
    }

  private:
    bool is_inside(std::uint32_t c) const { return grid_.value[node_[c]] < 0; }

    /// Sorts the corners inside first by exchanges; an odd number of exchanges turns the orientation around.
    void add_tetrahedron(std::array<std::uint32_t, 4> t) {
        bool is_odd = false;
        std::size_t inside = 0;
        for (std::size_t i = 0; i < 4; ++i)
            if (is_inside(t[i])) {
                if (i != inside) is_odd = !is_odd;
                std::swap(t[i], t[inside++]);
            }
        if (inside == 0 || inside == 4) return;
        if (is_odd && inside == 2) std::swap(t[0], t[1]);
        if (is_odd && inside == 1) std::swap(t[1], t[2]);
        if (is_odd && inside == 3) std::swap(t[0], t[1]);
        if (inside == 1) add_face(cut(t[0], t[1]), cut(t[0], t[2]), cut(t[0], t[3]));
        if (inside == 3) add_face(cut(t[0], t[3]), cut(t[1], t[3]), cut(t[2], t[3]));
        if (inside != 2) return;
        add_face(cut(t[0], t[2]), cut(t[0], t[3]), cut(t[1], t[3]));
        add_face(cut(t[0], t[2]), cut(t[1], t[3]), cut(t[1], t[2]));
    }

    void add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) { mesh_.faces.push_back({a, b, c}); }

    /// The vertex on the edge between two corners of the cube.
    std::uint32_t cut(std::uint32_t a, std::uint32_t b) {
        const std::uint64_t key = std::uint64_t{node_[a & b]} * 8 + (a ^ b);
        const auto [at, is_new] = vertex_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
        if (!is_new) return at->second;
        const std::uint32_t low = a & b, high = a | b;
        const float u = grid_.value[node_[low]], v = grid_.value[node_[high]];
        const float share = std::clamp(u / (u - v), k_node_margin, 1 - k_node_margin);
        const auto place = [&](std::uint32_t c) { return grid_.position(corner_[c][0], corner_[c][1], corner_[c][2]); };
        mesh_.vertices.push_back(place(low) * (1 - share) + place(high) * share);
        return at->second;
    }

    const ValueGrid& grid_;
    TriangleMesh mesh_;
    std::unordered_map<std::uint64_t, std::uint32_t> vertex_;
    std::array<std::array<std::uint32_t, 3>, 8> corner_{};
    std::array<std::size_t, 8> node_{};
};

}  // namespace

TriangleMesh level_surface(const ValueGrid& grid) {
    LevelTriangles triangles(grid);
    for (std::uint32_t z = 0; z + 1 < grid.size[2]; ++z) {
        check_interrupt();
        for (std::uint32_t y = 0; y + 1 < grid.size[1]; ++y)
            for (std::uint32_t x = 0; x + 1 < grid.size[0]; ++x) triangles.add_cube(x, y, z);
    }
    return triangles.finish();
}

}  // namespace exemplar
