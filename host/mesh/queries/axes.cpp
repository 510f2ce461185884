#include "host/mesh/queries/axes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/core/parallel.h"
#include "host/mesh/queries/point_tree.h"

namespace exemplar {

namespace {

/// Computes the covariance of the surface about `center`, and its area. Over a triangle with corners a, b, c the
/// integral of x x^T is area / 12 times (a a^T + b b^T + c c^T + s s^T), s = a + b + c.
Eigen::Matrix3d surface_covariance(const TriangleMesh& mesh, const Vec3d& center) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    double total = 0;
    for (const Face& face : mesh.faces) {
        std::array<Vec3d, 3> p;
        for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.vertices[face[i]].cast<double>() - center;
        const double area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
        const Vec3d s = p[0] + p[1] + p[2];
        sum += area / 12 *
               (p[0] * p[0].transpose() + p[1] * p[1].transpose() + p[2] * p[2].transpose() + s * s.transpose());
        total += area;
    }
    return total > 0 ? Eigen::Matrix3d(sum / total) : sum;
}

/// Computes the third moment of the surface along each column of `axes`. Over a triangle whose corners lie at a, b,
/// c along an axis, the integral of t^3 is area / 10 times the sum of the ten products of three of a, b, c.
Vec3d third_moments(const TriangleMesh& mesh, const Vec3d& center, const Eigen::Matrix3d& axes) {
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (const Face& face : mesh.faces) {
        std::array<Vec3d, 3> p;
        for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.vertices[face[i]].cast<double>() - center;
        const double area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
        const Eigen::Array3d a = axes.transpose() * p[0], b = axes.transpose() * p[1], c = axes.transpose() * p[2];
        sum += area / 10 * (a * a * (a + b + c) + b * b * (a + b + c) + c * c * (a + b + c) + a * b * c);
    }
    return sum;
}

}  // namespace

PrincipalAxes principal_axes(const TriangleMesh& mesh) {
    PrincipalAxes result;
    result.center = area_centroid(mesh);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(surface_covariance(mesh, result.center.cast<double>()));
    const Vec3d skew = third_moments(mesh, result.center.cast<double>(), solver.eigenvectors());
    for (int i = 0; i < 3; ++i) {
        const int source = 2 - i;  // eigenvalues are in increasing order
        result.axis[i] = (skew[source] < 0 ? -1.0F : 1.0F) * solver.eigenvectors().col(source).cast<float>();
        result.sigma[i] = static_cast<float>(std::sqrt(std::max(0.0, solver.eigenvalues()[source])));
    }
    return result;
}

namespace {

constexpr std::size_t k_sample_count = 8192;
constexpr std::size_t k_coarse_queries = 256, k_fine_queries = 400, k_final_queries = 2048;
constexpr int k_direction_steps = 13;       // 2 * 13^2 + 1 = 339 directions, 6 to 11 degrees apart
constexpr std::size_t k_refined_count = 8;  // candidates that a local search improves
constexpr float k_degree = std::numbers::pi_v<float> / 180;
constexpr float k_separation = 20 * k_degree;
constexpr float k_normal_weight = 0.01f;  // cost of opposite normals, relative to the diagonal

/// Spreads the bits of a 10-bit number, with two zeros between any two of them.
std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

/// Orders the faces along a space-filling (Morton) curve in the frame of the principal axes. Neighbors on the
/// surface come close together, and neither the order of the faces nor the pose of the mesh matters.
std::vector<std::uint32_t> faces_along_curve(const TriangleMesh& mesh, const PrincipalAxes& axes) {
    const std::vector<Vec3> centers = face_centers(mesh);
    float reach = 0;
    for (const Vec3& c : centers) reach = std::max(reach, (c - axes.center).norm());
    struct Key {
        std::uint32_t code, face;
        float along;
    };
    if (!(reach > 0)) reach = 1;  // all centers coincide, as of a single face
    std::vector<Key> keys(centers.size());
    for (std::uint32_t f = 0; f < keys.size(); ++f) {
        const Vec3 p = centers[f] - axes.center;
        std::uint32_t code = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const float unit = 0.5f + 0.5f * p.dot(axes.axis[i]) / reach;
            code |= spread_bits(static_cast<std::uint32_t>(std::clamp(unit * 1023.0f, 0.0f, 1023.0f))) << i;
        }
        keys[f] = {code, f, p.dot(axes.axis[0])};
    }
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        if (a.code != b.code) return a.code < b.code;
        return a.along != b.along ? a.along < b.along : a.face < b.face;
    });
    std::vector<std::uint32_t> order;
    order.reserve(keys.size());
    for (const Key& key : keys) order.push_back(key.face);
    return order;
}

/// Returns the axes as columns.
Eigen::Matrix3f frame(const PrincipalAxes& axes) {
    return (Eigen::Matrix3f() << axes.axis[0], axes.axis[1], axes.axis[2]).finished();
}

/// Points spread evenly over a surface, with unit normals, in the frame of its principal axes, so that results
/// rotate with the mesh.
struct SurfaceSamples {
    std::vector<Vec3> point, normal;
};

/// Returns `count` samples, one for each equal share of the area along the curve of faces. Within a face they follow
/// a low-discrepancy sequence. Empty if the area is zero.
SurfaceSamples sample_surface(const TriangleMesh& mesh, const PrincipalAxes& axes, std::size_t count) {
    const std::vector<float> areas = face_areas(mesh);
    const std::vector<Vec3> normals = face_normals(mesh);
    const Eigen::Matrix3f to_frame = frame(axes).transpose();
    double total = 0;
    for (float area : areas) total += static_cast<double>(area);
    SurfaceSamples samples;
    if (!(total > 0)) return samples;
    double passed = 0;
    for (std::uint32_t f : faces_along_curve(mesh, axes)) {
        passed += static_cast<double>(areas[f]);
        const Face& face = mesh.faces[f];
        while (samples.point.size() < count &&
               (static_cast<double>(samples.point.size()) + 0.5) * total <= passed * static_cast<double>(count)) {
            const auto i = static_cast<double>(samples.point.size() + 1);
            double s = std::fmod(i * 0.7548776662466927, 1.0), t = std::fmod(i * 0.5698402909980532, 1.0);
            if (s + t > 1) s = 1 - s, t = 1 - t;
            const Vec3 a = mesh.vertices[face[0]];
            const Vec3 point = a + static_cast<float>(s) * (mesh.vertices[face[1]] - a) +
                               static_cast<float>(t) * (mesh.vertices[face[2]] - a);
            samples.point.push_back(to_frame * (point - axes.center));
            samples.normal.push_back(to_frame * normals[f]);
        }
    }
    return samples;
}

/// Measures how far the surface is from being mapped to itself by a mirror plane through the area centroid.
struct Asymmetry {
    float distance;  ///< mean distance of the mirrored samples to the surface, over the diagonal
    float cost;      ///< the same plus a mild penalty for normals that differ; what the search minimizes
};

/// Measures mirror planes against samples of the surface.
class MirrorTest {
  public:
    MirrorTest(SurfaceSamples samples, float diagonal, float area)
        : samples_(std::move(samples)),
          diagonal_(diagonal),
          sample_radius_(std::sqrt(area / static_cast<float>(samples_.point.size()))),
          tree_(samples_.point) {}

    /// Mirrors `queries` samples, evenly chosen from all.
    Asymmetry measure(const Vec3& plane_normal, std::size_t queries) const {
        const std::size_t count = samples_.point.size(), stride = std::max<std::size_t>(1, count / queries);
        double distance = 0, mismatch = 0;
        std::size_t used = 0;
        for (std::size_t i = stride / 2; i < count; i += stride, ++used) {
            const Vec3 p = mirrored(samples_.point[i], plane_normal), n = mirrored(samples_.normal[i], plane_normal);
            const std::uint32_t nearest = tree_.nearest(p);
            distance += static_cast<double>(distance_to_sample(p - samples_.point[nearest], samples_.normal[nearest]));
            mismatch += 0.5 * (1.0 - static_cast<double>(n.dot(samples_.normal[nearest])));
        }
        const auto mean = [&](double sum) { return static_cast<float>(sum / static_cast<double>(used)); };
        const float relative = mean(distance) / diagonal_;
        return {relative, relative + k_normal_weight * mean(mismatch)};
    }

  private:
    static Vec3 mirrored(const Vec3& v, const Vec3& plane_normal) { return v - 2 * v.dot(plane_normal) * plane_normal; }
    /// Returns the distance to the disk of surface that a sample represents, so that the spacing of samples does not
    /// count as distance.
    float distance_to_sample(const Vec3& offset, const Vec3& normal) const {
        const float height = offset.dot(normal);
        const float along = std::sqrt(std::max(0.0f, offset.squaredNorm() - height * height));
        return std::hypot(height, std::max(0.0f, along - sample_radius_));
    }

    SurfaceSamples samples_;
    float diagonal_, sample_radius_;
    PointTree tree_;
};

/// A plane's normal and its asymmetry.
struct Candidate {
    Vec3 normal;
    Asymmetry asymmetry;
};

/// Returns half of the integer points on an octahedron, as directions. The set does not depend on the signs of the
/// axes.
std::vector<Vec3> hemisphere_directions() {
    std::vector<Vec3> directions;
    const int n = k_direction_steps;
    for (int x = -n; x <= n; ++x)
        for (int y = -n; y <= n; ++y) {
            const int z = n - std::abs(x) - std::abs(y);
            if (z < 0 || (z == 0 && (y < 0 || (y == 0 && x < 0)))) continue;
            directions.push_back(Eigen::Vector3i(z, y, x).cast<float>().normalized());
        }
    return directions;
}

bool separated(const Vec3& normal, const std::vector<Candidate>& chosen, float angle) {
    return std::ranges::none_of(
        chosen, [&](const Candidate& other) { return std::abs(normal.dot(other.normal)) > std::cos(angle); });
}

/// Returns the `count` best candidates, best first, each more than `angle` from those before it.
std::vector<Candidate> best_separated(std::vector<Candidate> candidates, std::size_t count, float angle) {
    std::ranges::stable_sort(candidates, {}, [](const Candidate& c) { return c.asymmetry.cost; });
    std::vector<Candidate> chosen;
    for (const Candidate& candidate : candidates) {
        if (chosen.size() == count) break;
        if (separated(candidate.normal, chosen, angle)) chosen.push_back(candidate);
    }
    return chosen;
}

/// Refines the normal by pattern search: tries tilts in eight directions, by ever smaller angles.
Candidate refined(const MirrorTest& test, const Vec3& start, std::size_t queries) {
    Candidate best{start, test.measure(start, queries)};
    for (float tilt = 5 * k_degree; tilt > 0.1f * k_degree; tilt *= 0.5f) {
        const Vec3 u = best.normal.unitOrthogonal(), v = best.normal.cross(u);
        Candidate next = best;
        for (int i = 0; i < 8; ++i) {
            const float angle = static_cast<float>(i) * std::numbers::pi_v<float> / 4;
            const Vec3 normal =
                (best.normal + std::tan(tilt) * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
            const Asymmetry asymmetry = test.measure(normal, queries);
            if (asymmetry.cost < next.asymmetry.cost) next = {normal, asymmetry};
        }
        best = next;
    }
    return best;
}

/// Returns candidates for all planes: the coarse ones, and the most promising of them refined.
std::vector<Candidate> search_planes(const MirrorTest& test) {
    const std::vector<Vec3> directions = hemisphere_directions();
    std::vector<Candidate> coarse(directions.size());
    parallel_for(
        directions.size(),
        [&](std::size_t i) {
            coarse[i] = {directions[i], test.measure(directions[i], k_coarse_queries)};
        },
        8);
    std::vector<Candidate> starts = best_separated(coarse, k_refined_count, 0.5f * k_separation);
    for (int i = 0; i < 3; ++i) starts.push_back({Vec3::Unit(i), {}});
    std::vector<Candidate> result(starts.size());
    parallel_for(starts.size(), [&](std::size_t i) {
        result[i] = refined(test, starts[i].normal, k_fine_queries);
        result[i].asymmetry = test.measure(result[i].normal, k_final_queries);
    });
    // The exact principal planes are added because a search may end beside them; coarse planes fill up the rest.
    for (int i = 0; i < 3; ++i) result.push_back({Vec3::Unit(i), test.measure(Vec3::Unit(i), k_final_queries)});
    result.insert(result.end(), coarse.begin(), coarse.end());
    return result;
}

}  // namespace

std::vector<SymmetryPlane> symmetry_planes(const TriangleMesh& mesh, int count) {
    const PrincipalAxes axes = principal_axes(mesh);
    const auto wanted = static_cast<std::size_t>(std::max(count, 0));
    SurfaceSamples samples = sample_surface(mesh, axes, k_sample_count);
    std::vector<Candidate> chosen;
    if (!samples.point.empty()) {
        double area = 0;
        for (float a : face_areas(mesh)) area += static_cast<double>(a);
        const BoundingBox box = bounding_box(mesh);
        const float diagonal = (box.high - box.low).cast<float>().norm();
        const MirrorTest test(std::move(samples), diagonal, static_cast<float>(area));
        chosen = best_separated(search_planes(test), wanted, k_separation);
        for (Candidate& c : chosen) c.asymmetry = test.measure(c.normal, k_final_queries);
        std::ranges::stable_sort(chosen, {}, [](const Candidate& c) { return c.asymmetry.distance; });
    }
    std::vector<SymmetryPlane> planes;
    planes.reserve(wanted);
    for (const Candidate& c : chosen) planes.push_back({axes.center, frame(axes) * c.normal, c.asymmetry.distance});
    for (std::size_t i = 0; planes.size() < wanted; ++i)
        planes.push_back({axes.center, axes.axis[i % 3], planes.empty() ? 0.0f : planes.back().error});
    return planes;
}

}  // namespace exemplar
