#include "host/imaging/scan_conversion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "host/core/parallel.h"

namespace exemplar {
namespace {

using Vec4 = Eigen::Vector4f;

constexpr int k_subpixels = 256;    // fixed-point positions make coverage exact, so shared edges have no gaps
constexpr float k_guard_band = 64;  // in units of the view's half width; keeps fixed-point products inside 64 bits
constexpr std::size_t k_band = 32;  // sample rows per task

struct ClipVertex {
    Vec4 position;  // clip space
    Vec3 weight;    // barycentric coordinates in the source triangle
};

/// A triangle inside the guard band, ready for scan conversion.
struct ScreenTriangle {
    std::array<std::int64_t, 3> x, y;  // sample grid, in 1 / k_subpixels
    std::array<double, 3> depth, inverse_w;
    std::array<Vec3, 3> weight;
    std::uint32_t face;
    std::int64_t area;  // twice the signed area, positive after ordering
};

std::vector<ClipVertex> clip_polygon(const std::vector<ClipVertex>& polygon, const Vec4& plane) {
    std::vector<ClipVertex> out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const ClipVertex& a = polygon[i];
        const ClipVertex& b = polygon[(i + 1) % polygon.size()];
        const float da = plane.dot(a.position), db = plane.dot(b.position);
        if (da >= 0) out.push_back(a);
        if ((da >= 0) != (db >= 0)) {
            const float t = da / (da - db);
            out.push_back({a.position + t * (b.position - a.position), a.weight + t * (b.weight - a.weight)});
        }
    }
    return out;
}

/// Returns the planes with visible points on their positive side: near, far, and the guard band.
const std::array<Vec4, 6>& clip_planes() {
    static const std::array<Vec4, 6> planes{Vec4(0, 0, 1, 0),
                                            Vec4(0, 0, -1, 1),
                                            Vec4(1, 0, 0, k_guard_band),
                                            Vec4(-1, 0, 0, k_guard_band),
                                            Vec4(0, 1, 0, k_guard_band),
                                            Vec4(0, -1, 0, k_guard_band)};
    return planes;
}

/// Appends a clip-space triangle in screen coordinates, ordered to a positive area; skips it if it has none.
void append_screen_triangle(std::array<ClipVertex, 3> corners, std::uint32_t face, int columns, int rows,
                            std::vector<ScreenTriangle>& out) {
    ScreenTriangle t;
    t.face = face;
    const auto fixed = [](double ndc, int size) { return std::llround((ndc + 1) * 0.5 * size * k_subpixels); };
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec4& p = corners[i].position;
        t.inverse_w[i] = 1.0 / static_cast<double>(p.w());
        t.x[i] = fixed(p.x() * t.inverse_w[i], columns);
        t.y[i] = fixed(p.y() * t.inverse_w[i], rows);
        t.depth[i] = p.z() * t.inverse_w[i];
        t.weight[i] = corners[i].weight;
    }
    t.area = (t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - (t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
    if (t.area == 0) return;
    if (t.area < 0) {
        std::swap(t.x[1], t.x[2]);
        std::swap(t.y[1], t.y[2]);
        std::swap(t.depth[1], t.depth[2]);
        std::swap(t.inverse_w[1], t.inverse_w[2]);
        std::swap(t.weight[1], t.weight[2]);
        t.area = -t.area;
    }
    out.push_back(t);
}

std::vector<ScreenTriangle> screen_triangles(const TriangleMesh& mesh, const Camera& camera, int columns, int rows) {
    const Eigen::Matrix4f matrix = camera.view_projection();
    std::vector<Vec4> clip(mesh.vertices.size());
    for (std::size_t v = 0; v < clip.size(); ++v) clip[v] = matrix * mesh.vertices[v].homogeneous();

    std::vector<ScreenTriangle> out;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        std::vector<ClipVertex> polygon{{clip[a], Vec3::UnitX()}, {clip[b], Vec3::UnitY()}, {clip[c], Vec3::UnitZ()}};
        for (const Vec4& plane : clip_planes()) {
            const bool inside = std::all_of(polygon.begin(), polygon.end(),
                                            [&](const ClipVertex& v) { return plane.dot(v.position) >= 0; });
            if (!inside) polygon = clip_polygon(polygon, plane);
        }
        for (std::size_t i = 2; i < polygon.size(); ++i)
            append_screen_triangle({polygon[0], polygon[i - 1], polygon[i]}, f, columns, rows, out);
    }
    return out;
}

/// Returns twice the signed area of (a, b, p), in squared subpixels.
std::int64_t edge_function(const ScreenTriangle& t, std::size_t a, std::size_t b, std::int64_t x, std::int64_t y) {
    return (t.x[b] - t.x[a]) * (y - t.y[a]) - (t.y[b] - t.y[a]) * (x - t.x[a]);
}

/// Returns whether samples exactly on the edge a -> b belong to the triangle: on top and left edges only, so that of
/// two triangles that share an edge exactly one covers each sample.
bool owns_edge(const ScreenTriangle& t, std::size_t a, std::size_t b) {
    const std::int64_t dx = t.x[b] - t.x[a], dy = t.y[b] - t.y[a];
    return dy < 0 || (dy == 0 && dx > 0);
}

/// Returns the half-open range of samples whose centers lie between the smallest and the largest of v, clamped to
/// [begin, end).
std::array<std::int64_t, 2> sample_range(const std::array<std::int64_t, 3>& v, std::int64_t begin, std::int64_t end) {
    const auto [low, high] = std::minmax_element(v.begin(), v.end());
    const auto floor_div = [](std::int64_t a) {
        return a >= 0 ? a / k_subpixels : -((-a + k_subpixels - 1) / k_subpixels);
    };
    return {std::max(begin, floor_div(*low - k_subpixels / 2)), std::min(end, floor_div(*high - k_subpixels / 2) + 1)};
}

void scan_triangle(const ScreenTriangle& t, int columns, std::size_t row_begin, std::size_t row_end,
                   std::vector<VisibleSample>& samples) {
    const auto ys = sample_range(t.y, static_cast<std::int64_t>(row_begin), static_cast<std::int64_t>(row_end));
    const auto xs = sample_range(t.x, 0, columns);
    const std::array<std::int64_t, 3> least{owns_edge(t, 1, 2) ? 0 : 1, owns_edge(t, 2, 0) ? 0 : 1,
                                            owns_edge(t, 0, 1) ? 0 : 1};
    for (std::int64_t y = ys[0]; y < ys[1]; ++y) {
        for (std::int64_t x = xs[0]; x < xs[1]; ++x) {
            const std::int64_t px = x * k_subpixels + k_subpixels / 2, py = y * k_subpixels + k_subpixels / 2;
            const std::array<std::int64_t, 3> e{edge_function(t, 1, 2, px, py), edge_function(t, 2, 0, px, py),
                                                edge_function(t, 0, 1, px, py)};
            if (e[0] < least[0] || e[1] < least[1] || e[2] < least[2]) continue;
            double depth = 0, total = 0;
            std::array<double, 3> perspective{};
            for (std::size_t i = 0; i < 3; ++i) {
                const double b = static_cast<double>(e[i]) / static_cast<double>(t.area);
                depth += b * t.depth[i];  // z / w is linear on the screen
                total += perspective[i] = b * t.inverse_w[i];
            }
            VisibleSample& sample =
                samples[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)];
            if (depth >= sample.depth) continue;
            sample.depth = depth;
            sample.face = t.face;
            sample.weight = Vec3::Zero();
            for (std::size_t i = 0; i < 3; ++i)
                sample.weight += static_cast<float>(perspective[i] / total) * t.weight[i];
        }
    }
}

}  // namespace

std::vector<VisibleSample> visible_samples(const TriangleMesh& mesh, const Camera& camera, int columns, int rows) {
    const std::vector<ScreenTriangle> triangles = screen_triangles(mesh, camera, columns, rows);
    const std::size_t row_count = static_cast<std::size_t>(rows);
    std::vector<VisibleSample> samples(static_cast<std::size_t>(columns) * row_count);
    parallel_for((row_count + k_band - 1) / k_band, [&](std::size_t band) {
        const std::size_t begin = band * k_band, end = std::min(begin + k_band, row_count);
        for (const ScreenTriangle& t : triangles) scan_triangle(t, columns, begin, end, samples);
    });
    return samples;
}

}  // namespace exemplar
