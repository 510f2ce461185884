#include "host/parts/prototype/lens_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "host/core/parallel.h"
#include "host/mesh/queries/point_tree.h"

namespace exemplar {
namespace {

/// Nodes around the silhouette, so that the outline never meets the border.
constexpr float k_silhouette_margin = 4;

OutlineGrid grid_around(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces, float cell) {
    Vec2 low = Vec2::Constant(1e30F), high = -low;
    for (const std::uint32_t f : faces)
        for (const std::uint32_t v : mesh.faces[f]) {
            low = low.cwiseMin(mesh.vertices[v].head<2>());
            high = high.cwiseMax(mesh.vertices[v].head<2>());
        }
    OutlineGrid grid;
    grid.cell = cell;
    grid.origin = low - Vec2::Constant(k_silhouette_margin * cell);
    grid.width = static_cast<std::uint32_t>((high - low).x() / cell + 2 * k_silhouette_margin) + 2;
    grid.height = static_cast<std::uint32_t>((high - low).y() / cell + 2 * k_silhouette_margin) + 2;
    return grid;
}

float turn_of(const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// Marks the nodes that a triangle covers.
void cover(const OutlineGrid& grid, std::array<Vec2, 3> t, std::vector<std::uint8_t>& covered) {
    if (turn_of(t[0], t[1], t[2]) < 0) std::swap(t[1], t[2]);
    const Vec2 low = (t[0].cwiseMin(t[1]).cwiseMin(t[2]) - grid.origin) / grid.cell,
               high = (t[0].cwiseMax(t[1]).cwiseMax(t[2]) - grid.origin) / grid.cell;
    for (auto y = static_cast<std::uint32_t>(std::ceil(low.y())); static_cast<float>(y) <= high.y(); ++y)
        for (auto x = static_cast<std::uint32_t>(std::ceil(low.x())); static_cast<float>(x) <= high.x(); ++x) {
            const Vec2 p = grid.position(x, y);
            if (turn_of(t[0], t[1], p) >= 0 && turn_of(t[1], t[2], p) >= 0 && turn_of(t[2], t[0], p) >= 0)
                covered[grid.index(x, y)] = 1;
        }
}

/// The middles between covered nodes and neighbors that are not.
std::vector<Vec3> border_points(const OutlineGrid& grid, const std::vector<std::uint8_t>& covered) {
    std::vector<Vec3> border;
    const auto add = [&](std::uint32_t x, std::uint32_t y, std::uint32_t right, std::uint32_t up) {
        if (covered[grid.index(x, y)] == covered[grid.index(x + right, y + up)]) return;
        const Vec2 middle = (grid.position(x, y) + grid.position(x + right, y + up)) / 2;
        border.emplace_back(middle.x(), middle.y(), 0);
    };
    for (std::uint32_t y = 0; y + 1 < grid.height; ++y)
        for (std::uint32_t x = 0; x + 1 < grid.width; ++x) {
            add(x, y, 1, 0);
            add(x, y, 0, 1);
        }
    return border;
}

/// Replaces each value by the mean of its 3 x 3 neighbors, so that the steps of pixels vanish.
void blur(OutlineGrid& grid) {
    const std::vector<float> before = grid.value;
    for (std::uint32_t y = 1; y + 1 < grid.height; ++y)
        for (std::uint32_t x = 1; x + 1 < grid.width; ++x) {
            float sum = 0;
            for (std::uint32_t k = 0; k < 9; ++k) sum += before[grid.index(x + k % 3 - 1, y + k / 3 - 1)];
            grid.value[grid.index(x, y)] = sum / 9;
        }
}

/// Numbers the connected areas of negative values; returns the number of nodes of each.
std::vector<std::size_t> number_areas(const OutlineGrid& grid, std::vector<std::uint32_t>& area) {
    std::vector<std::size_t> size;
    std::vector<std::size_t> open;
    for (std::size_t seed = 0; seed < grid.value.size(); ++seed) {
        if (grid.value[seed] >= 0 || area[seed] > 0) continue;
        size.push_back(0);
        open.push_back(seed);
        area[seed] = static_cast<std::uint32_t>(size.size());
        while (!open.empty()) {
            const std::size_t at = open.back();
            open.pop_back();
            ++size.back();
            const std::size_t x = at % grid.width, y = at / grid.width;
            const auto visit = [&](bool exists, std::size_t next) {
                if (!exists || grid.value[next] >= 0 || area[next] > 0) return;
                area[next] = static_cast<std::uint32_t>(size.size());
                open.push_back(next);
            };
            visit(x > 0, at - 1);
            visit(x + 1 < grid.width, at + 1);
            visit(y > 0, at - grid.width);
            visit(y + 1 < grid.height, at + grid.width);
        }
    }
    return size;
}

/// Links the crossings of grid edges to the next one around the negative values.
class OutlineLinks {
  public:
    explicit OutlineLinks(const OutlineGrid& grid) : grid_(grid) {}

    /// The four corners of a square, counter-clockwise. A saddle gets two lines that separate its negative corners.
    void add_square(std::uint32_t x, std::uint32_t y) {
        const std::array<std::size_t, 4> node{grid_.index(x, y), grid_.index(x + 1, y), grid_.index(x + 1, y + 1),
                                              grid_.index(x, y + 1)};
        for (std::size_t i = 0; i < 4; ++i) {
            if (!leaves(node, i)) continue;
            std::size_t back = i;
            while (!enters(node, back)) back = (back + 3) % 4;
            next_[edge(node[i], node[(i + 1) % 4])] = edge(node[back], node[(back + 1) % 4]);
        }
    }

    std::vector<std::vector<Vec2>> loops() {
        std::vector<std::uint64_t> begins;
        begins.reserve(next_.size());
        for (const auto& link : next_) begins.push_back(link.first);
        std::sort(begins.begin(), begins.end());
        std::vector<std::vector<Vec2>> all;
        for (std::uint64_t begin : begins) {
            std::vector<Vec2> loop;
            for (auto link = next_.find(begin); link != next_.end(); link = next_.find(begin)) {
                loop.push_back(crossing(begin));
                begin = link->second;
                next_.erase(link);
            }
            if (loop.size() >= 3) all.push_back(std::move(loop));
        }
        return all;
    }

  private:
    bool is_inside(std::size_t n) const { return grid_.value[n] < 0; }
    /// Whether the way around the square leaves, or enters, the negative values between corner i and the next.
    bool leaves(const std::array<std::size_t, 4>& node, std::size_t i) const {
        return is_inside(node[i]) && !is_inside(node[(i + 1) % 4]);
    }
    bool enters(const std::array<std::size_t, 4>& node, std::size_t i) const {
        return !is_inside(node[i]) && is_inside(node[(i + 1) % 4]);
    }
    std::uint64_t edge(std::size_t a, std::size_t b) const {
        return 2 * std::uint64_t{std::min(a, b)} + (std::max(a, b) - std::min(a, b) == 1 ? 0 : 1);
    }
    Vec2 crossing(std::uint64_t edge) const {
        const std::size_t a = edge / 2, b = a + (edge % 2 == 0 ? 1 : grid_.width);
        const float share = grid_.value[a] / (grid_.value[a] - grid_.value[b]);
        const auto place = [&](std::size_t n) {
            return grid_.position(static_cast<std::uint32_t>(n % grid_.width),
                                  static_cast<std::uint32_t>(n / grid_.width));
        };
        return place(a) + share * (place(b) - place(a));
    }

    const OutlineGrid& grid_;
    std::unordered_map<std::uint64_t, std::uint64_t> next_;
};

}  // namespace

float OutlineGrid::operator()(const Vec2& point) const {
    const Vec2 at = (point - origin) / cell;
    const float u = std::clamp(at.x(), 0.0F, static_cast<float>(width - 1)),
                v = std::clamp(at.y(), 0.0F, static_cast<float>(height - 1));
    const auto x = std::min(static_cast<std::uint32_t>(u), width - 2),
               y = std::min(static_cast<std::uint32_t>(v), height - 2);
    const float s = u - static_cast<float>(x), t = v - static_cast<float>(y);
    return (1 - t) * ((1 - s) * value[index(x, y)] + s * value[index(x + 1, y)]) +
           t * ((1 - s) * value[index(x, y + 1)] + s * value[index(x + 1, y + 1)]);
}

OutlineGrid silhouette_distances(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces, float cell,
                                 const std::function<bool(const Vec2&)>& allowed) {
    OutlineGrid grid = grid_around(mesh, faces, cell);
    std::vector<std::uint8_t> covered(std::size_t{grid.width} * grid.height, 0);
    for (const std::uint32_t f : faces) {
        const Face& face = mesh.faces[f];
        cover(grid,
              {mesh.vertices[face[0]].head<2>(), mesh.vertices[face[1]].head<2>(), mesh.vertices[face[2]].head<2>()},
              covered);
    }
    for (std::uint32_t y = 0; y < grid.height; ++y)
        for (std::uint32_t x = 0; x < grid.width; ++x)
            if (!allowed(grid.position(x, y))) covered[grid.index(x, y)] = 0;
    grid.value.assign(covered.size(), cell);
    std::vector<Vec3> border = border_points(grid, covered);
    if (border.empty()) return grid;
    const PointTree tree(border);
    parallel_for(grid.height, [&](std::size_t row) {
        const auto y = static_cast<std::uint32_t>(row);
        for (std::uint32_t x = 0; x < grid.width; ++x) {
            const Vec2 p = grid.position(x, y);
            const Vec3 point(p.x(), p.y(), 0);
            const float distance = (border[tree.nearest(point)] - point).norm();
            grid.value[grid.index(x, y)] = covered[grid.index(x, y)] == 1 ? -distance : distance;
        }
    });
    for (int i = 0; i < 2; ++i) blur(grid);
    return grid;
}

void keep_largest_area(OutlineGrid& grid) {
    std::vector<std::uint32_t> area(grid.value.size(), 0);
    const std::vector<std::size_t> size = number_areas(grid, area);
    if (size.empty()) return;
    const auto largest = static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin() + 1);
    for (std::size_t n = 0; n < area.size(); ++n)
        if (grid.value[n] < 0 && area[n] != largest) grid.value[n] = -grid.value[n];
}

std::vector<std::vector<Vec2>> outlines_of(const OutlineGrid& grid) {
    OutlineLinks links(grid);
    for (std::uint32_t y = 0; y + 1 < grid.height; ++y)
        for (std::uint32_t x = 0; x + 1 < grid.width; ++x) links.add_square(x, y);
    return links.loops();
}

}  // namespace exemplar
