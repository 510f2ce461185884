#include "host/mesh/io/io_polygons.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/mesh/io/io_origin.h"

namespace exemplar::mesh_io {
namespace {

using Point = Eigen::Vector2d;

/// Bounds on ear clipping, which takes at least quadratic time. Polygons with more corners are cut into a fan. A
/// simple polygon of n corners looks at about n^2 / 2 corners; one that crosses itself many times would look at n^3,
/// so its remainder is cut into a fan after k_max_corner_checks times n^2.
constexpr std::size_t k_max_ear_corners = 4000, k_max_corner_checks = 4;

/// Projects the polygon into the plane of its area vector (Newell), counter-clockwise; empty if it has no area.
std::vector<Point> flattened(std::span<const Vec3> vertices, std::span<const std::uint32_t> corners) {
    const Vec3d origin = vertices[corners[0]].cast<double>();
    Vec3d area = Vec3d::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        area += (vertices[corners[i]].cast<double>() - origin).cross(vertices[corners[i + 1]].cast<double>() - origin);
    const double length = area.norm();
    if (!(length > 0) || !std::isfinite(length)) return {};
    const Vec3d normal = area / length, u = normal.unitOrthogonal(), v = normal.cross(u);
    std::vector<Point> points;
    points.reserve(corners.size());
    for (std::uint32_t corner : corners) {
        const Vec3d p = vertices[corner].cast<double>() - origin;
        points.push_back({p.dot(u), p.dot(v)});
    }
    return points;
}

/// Returns twice the signed area of the triangle a b c.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Returns whether the polygon is strictly convex: a fan over collinear corners would have triangles without area.
bool is_convex(std::span<const Point> points) {
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i)
        if (!(turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) > 0)) return false;
    return true;
}

void add_fan(std::span<const std::uint32_t> corners, std::vector<Face>& faces) {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) faces.push_back({corners[0], corners[i], corners[i + 1]});
}

/// Clips the ears of a polygon one by one.
class EarClipper {
  public:
    explicit EarClipper(std::vector<Point> points) : points_(std::move(points)), left_(points_.size()) {
        std::iota(left_.begin(), left_.end(), std::size_t{0});
    }
    /// Removes the next ear and returns its corner numbers; those of any corner where no proper ear is left.
    std::array<std::size_t, 3> clip() {
        const std::size_t n = left_.size();
        std::size_t at = n - 1;              // no ear: the polygon crosses itself or is flat
        for (std::size_t k = 0; k < n; ++k)  // the corner before the last ear is often one now
            if (const std::size_t i = (start_ + k) % n; is_ear(i)) {
                at = i;
                break;
            }
        const std::array<std::size_t, 3> ear{left_[(at + n - 1) % n], left_[at], left_[(at + 1) % n]};
        left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
        start_ = at > 0 ? at - 1 : 0;
        return ear;
    }
    std::size_t size() const { return left_.size(); }
    /// Returns the corner numbers of the remaining polygon.
    std::span<const std::size_t> left() const { return left_; }
    /// Returns how many corners were looked at.
    std::size_t corner_checks() const { return looks_; }

  private:
    bool is_ear(std::size_t i) {
        ++looks_;
        const std::size_t n = left_.size();
        const Point &a = points_[left_[(i + n - 1) % n]], &b = points_[left_[i]], &c = points_[left_[(i + 1) % n]];
        if (!(turn(a, b, c) > 0)) return false;
        for (std::size_t other : left_) {
            ++looks_;
            const Point& p = points_[other];
            if (p == a || p == b || p == c) continue;
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    }
    std::vector<Point> points_;
    std::vector<std::size_t> left_;
    std::size_t start_ = 0;  ///< where the search for the next ear begins
    std::size_t looks_ = 0;
};

}  // namespace

void triangulate_polygon(std::span<const Vec3> vertices, std::span<const std::uint32_t> corners,
                         std::vector<Face>& faces) {
    if (corners.size() <= 3 || corners.size() > k_max_ear_corners) return add_fan(corners, faces);
    std::vector<Point> points = flattened(vertices, corners);
    if (points.empty() || is_convex(points)) return add_fan(corners, faces);
    EarClipper clipper(std::move(points));
    const std::size_t max_looks = k_max_corner_checks * corners.size() * corners.size();
    while (clipper.size() >= 3 && clipper.corner_checks() < max_looks) {
        const auto [a, b, c] = clipper.clip();
        faces.push_back({corners[a], corners[b], corners[c]});
    }
    std::vector<std::uint32_t> left;
    for (std::size_t corner : clipper.left()) left.push_back(corners[corner]);
    add_fan(left, faces);
}

void PolygonList::reserve_polygons(std::size_t polygons) {
    corner_count_.reserve(polygons);
    corners_.reserve(3 * polygons);
}

void PolygonList::add(std::span<const std::uint32_t> corners) {
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    corner_count_.push_back(static_cast<std::uint32_t>(corners.size()));
}

std::vector<std::uint32_t> PolygonList::corners_of_triangles() const {
    std::vector<std::uint32_t> kept;
    kept.reserve(corners_.size());
    std::size_t begin = 0;
    for (const std::uint32_t count : corner_count_) {
        const auto polygon = std::span(corners_).subspan(begin, count);
        if (count >= 3) kept.insert(kept.end(), polygon.begin(), polygon.end());
        begin += count;
    }
    return kept;
}

TriangleMesh PolygonList::triangulate(std::vector<std::string>& warnings) && {
    TriangleMesh mesh;
    if (!positions.empty()) {
        mesh.origin = origin_for_floats(positions, corners_of_triangles());
        vertices.reserve(positions.size());
        for (const Vec3d& position : positions) vertices.push_back((position - mesh.origin).cast<float>());
        positions = {};
    }
    mesh.vertices = std::move(vertices);
    mesh.source_face_count = static_cast<std::uint32_t>(size());
    std::size_t triangles = 0, dropped = 0, first_dropped = 0;
    for (std::size_t i = 0; i < size(); ++i) {
        triangles += std::max(corner_count_[i], 2u) - 2;
        if (corner_count_[i] < 3 && dropped++ == 0) first_dropped = i;
    }
    const bool only_triangles = std::ranges::all_of(corner_count_, [](std::uint32_t count) { return count == 3; });
    mesh.faces.reserve(triangles);
    if (!only_triangles) mesh.source_face.reserve(triangles);
    std::size_t begin = 0;
    for (std::uint32_t i = 0; i < mesh.source_face_count; ++i) {
        triangulate_polygon(mesh.vertices, std::span(corners_).subspan(begin, corner_count_[i]), mesh.faces);
        begin += corner_count_[i];
        if (!only_triangles) mesh.source_face.resize(mesh.faces.size(), i);
    }
    if (dropped)
        warnings.push_back(fmt::format(
            "{} faces have fewer than three corners and were left out (the first is face {})", dropped, first_dropped));
    return mesh;
}

void PolygonList::triangulate_into(MeshFile& file) && {
    file.mesh = std::move(*this).triangulate(file.warnings);
    if (std::ranges::all_of(corner_count_, [](std::uint32_t count) { return count == 3; })) return;
    file.polygons = {std::move(corner_count_), std::move(corners_)};
}

}  // namespace exemplar::mesh_io
