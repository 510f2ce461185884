#include "host/synth/modeling/polygonize.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "host/core/parallel.h"

namespace exemplar {
namespace {

constexpr std::uint32_t k_block = 16;  // nodes along a block's side, a power of two

/// Field values on a regular grid; node (x, y, z) lies at origin + cell * (x, y, z).
struct Grid {
    std::array<std::uint32_t, 3> size{};  // nodes per axis, multiples of k_block
    Vec3 origin;
    float cell;
    std::vector<float> value;

    std::size_t index(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return (std::size_t{z} * size[1] + y) * size[0] + x;
    }
    Vec3 position(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return origin + cell * Vec3(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }
};

/// Fills a cube of side^3 nodes: with its center's value if the surface cannot pass through, else by recursive
/// halving. Skipped nodes keep the right sign, so the result is closed even where the distance estimate errs.
void fill_block(const ImplicitField& field, Grid& grid, std::array<std::uint32_t, 3> at, std::uint32_t side,
                std::span<const std::uint32_t> active) {
    if (side == 1) {
        grid.value[grid.index(at[0], at[1], at[2])] = field.value(grid.position(at[0], at[1], at[2]), active);
        return;
    }
    const float half = static_cast<float>(side - 1) / 2 * grid.cell;
    const Vec3 center = grid.position(at[0], at[1], at[2]) + Vec3::Constant(half);
    const float radius = half * 1.7320508f;
    const float value = field.value(center, active);
    if (std::abs(value) > 1.3f * (radius + grid.cell)) {
        for (std::uint32_t z = at[2]; z < at[2] + side; ++z)
            for (std::uint32_t y = at[1]; y < at[1] + side; ++y)
                std::fill_n(grid.value.begin() + static_cast<std::ptrdiff_t>(grid.index(at[0], y, z)), side, value);
        return;
    }
    std::vector<std::uint32_t> narrowed;
    if (side > 2) {
        narrowed = field.active_near(center, radius, active);
        active = narrowed;
    }
    const std::uint32_t step = side / 2;
    for (std::uint32_t child = 0; child < 8; ++child)
        fill_block(field, grid,
                   {at[0] + (child & 1) * step, at[1] + (child >> 1 & 1) * step, at[2] + (child >> 2) * step}, step,
                   active);
}

Grid sample_grid(const ImplicitField& field, float cell) {
    Grid grid;
    grid.cell = cell;
    grid.origin = field.low() - Vec3::Constant(2 * cell);
    std::array<std::uint32_t, 3> blocks{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        const float nodes = (field.high()[a] - field.low()[a]) / cell + 5;
        blocks[axis] = static_cast<std::uint32_t>(nodes) / k_block + 1;
        grid.size[axis] = blocks[axis] * k_block;
    }
    grid.value.resize(std::size_t{grid.size[0]} * grid.size[1] * grid.size[2]);
    std::vector<std::uint32_t> all(field.size());
    std::iota(all.begin(), all.end(), 0u);
    parallel_for(std::size_t{blocks[0]} * blocks[1] * blocks[2], [&](std::size_t block) {
        const auto b = static_cast<std::uint32_t>(block);
        fill_block(
            field, grid,
            {b % blocks[0] * k_block, b / blocks[0] % blocks[1] * k_block, b / (blocks[0] * blocks[1]) * k_block},
            k_block, all);
    });
    return grid;
}

/// Key of a grid edge that the surface crosses: lower node * 8 + the corner (1..7) of the cube above it where it
/// ends.
using EdgeKey = std::uint64_t;
using KeyTriangle = std::array<EdgeKey, 3>;

/// Corners of a cube are numbered by their bits (x, y, z). The tetrahedra follow the six monotone paths from 0 to 7.
constexpr std::array<std::array<std::uint32_t, 4>, 6> k_tetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

/// Appends the triangles of one tetrahedron, given positively oriented corners, their keys and which are inside.
class TetrahedronCutter {
  public:
    TetrahedronCutter(const Grid& grid, std::vector<KeyTriangle>& out) : grid_(grid), out_(out) {}

    void cut_cube(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        std::uint32_t inside = 0;
        for (std::uint32_t c = 0; c < 8; ++c) {
            node_[c] = grid_.index(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
            inside |= static_cast<std::uint32_t>(grid_.value[node_[c]] < 0) << c;
        }
        if (inside == 0 || inside == 255) return;
        for (const auto& tetrahedron : k_tetrahedra) cut(tetrahedron, inside);
    }

  private:
    EdgeKey key(std::uint32_t a, std::uint32_t b) const { return EdgeKey{node_[a & b]} * 8 + (a ^ b); }

    void cut(const std::array<std::uint32_t, 4>& t, std::uint32_t inside) {
        std::array<std::uint32_t, 4> order{};  // inside corners first, an even permutation of t
        std::uint32_t mask = 0;
        for (std::uint32_t i = 0; i < 4; ++i) mask |= (inside >> t[i] & 1) << i;
        if (mask == 0 || mask == 15) return;
        static constexpr std::array<std::array<std::uint8_t, 4>, 16> k_even{{{0, 1, 2, 3},
                                                                             {0, 1, 2, 3},
                                                                             {1, 0, 3, 2},
                                                                             {0, 1, 2, 3},
                                                                             {2, 0, 1, 3},
                                                                             {0, 2, 3, 1},
                                                                             {1, 2, 0, 3},
                                                                             {0, 1, 2, 3},
                                                                             {3, 2, 1, 0},
                                                                             {0, 3, 1, 2},
                                                                             {1, 3, 2, 0},
                                                                             {0, 3, 1, 2},
                                                                             {2, 3, 0, 1},
                                                                             {0, 2, 3, 1},
                                                                             {1, 3, 2, 0},
                                                                             {0, 1, 2, 3}}};
        for (std::size_t i = 0; i < 4; ++i) order[i] = t[k_even[mask][i]];
        const auto [a, b, c, d] = order;
        switch (std::popcount(mask)) {
            case 1:
                out_.push_back({key(a, b), key(a, c), key(a, d)});
                break;
            case 3:
                out_.push_back({key(a, d), key(b, d), key(c, d)});
                break;
            default:  // the quadrilateral between {a, b} inside and {c, d} outside
                out_.push_back({key(a, c), key(a, d), key(b, d)});
                out_.push_back({key(a, c), key(b, d), key(b, c)});
        }
    }

    const Grid& grid_;
    std::vector<KeyTriangle>& out_;
    std::array<std::size_t, 8> node_{};
};

std::vector<KeyTriangle> cut_grid(const Grid& grid) {
    std::vector<std::vector<KeyTriangle>> layers(grid.size[2] - 1);
    parallel_for(layers.size(), [&](std::size_t z) {
        TetrahedronCutter cutter(grid, layers[z]);
        for (std::uint32_t y = 0; y + 1 < grid.size[1]; ++y)
            for (std::uint32_t x = 0; x + 1 < grid.size[0]; ++x) cutter.cut_cube(x, y, static_cast<std::uint32_t>(z));
    });
    std::vector<KeyTriangle> all;
    for (const auto& layer : layers) all.insert(all.end(), layer.begin(), layer.end());
    return all;
}

/// Returns where the field, assumed linear along the edge, is zero; kept off the nodes so that no triangle
/// collapses.
Vec3 crossing(const Grid& grid, EdgeKey key) {
    const std::size_t node = key / 8;
    const auto corner = static_cast<std::uint32_t>(key % 8);
    const auto x = static_cast<std::uint32_t>(node % grid.size[0]);
    const auto y = static_cast<std::uint32_t>(node / grid.size[0] % grid.size[1]);
    const auto z = static_cast<std::uint32_t>(node / grid.size[0] / grid.size[1]);
    const std::uint32_t x1 = x + (corner & 1), y1 = y + (corner >> 1 & 1), z1 = z + (corner >> 2);
    const float a = grid.value[node], b = grid.value[grid.index(x1, y1, z1)];
    const float t = std::clamp(a / (a - b), 0.1f, 0.9f);
    return grid.position(x, y, z) * (1 - t) + grid.position(x1, y1, z1) * t;
}

}  // namespace

TriangleMesh polygonize(const ImplicitField& field, float cell) {
    const Grid grid = sample_grid(field, cell);
    const std::vector<KeyTriangle> triangles = cut_grid(grid);
    std::vector<EdgeKey> keys;
    keys.reserve(triangles.size() * 3);
    for (const KeyTriangle& t : triangles) keys.insert(keys.end(), t.begin(), t.end());
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());

    TriangleMesh mesh;
    mesh.vertices.resize(keys.size());
    parallel_for(
        keys.size(), [&](std::size_t v) { mesh.vertices[v] = crossing(grid, keys[v]); }, 512);
    mesh.faces.resize(triangles.size());
    parallel_for(
        triangles.size(),
        [&](std::size_t f) {
            for (std::size_t i = 0; i < 3; ++i) {
                const auto found = std::lower_bound(keys.begin(), keys.end(), triangles[f][i]);
                mesh.faces[f][i] = static_cast<std::uint32_t>(found - keys.begin());
            }
        },
        512);
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.faces.size());
    return mesh;
}

}  // namespace exemplar
