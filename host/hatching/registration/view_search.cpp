#include "host/hatching/registration/view_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/core/parallel.h"
#include "host/hatching/tracing/region_outline.h"

namespace exemplar {
namespace {

constexpr std::size_t k_view_directions = 1200;       ///< about six degrees apart
constexpr std::array<double, 2> k_distances{1.8, 4};  ///< of the eye, in radii: perspective changes what is seen
constexpr std::size_t k_fitted_views = 96;            ///< that are fitted
constexpr int k_picture = 64;                         ///< pixels of the pictures that are compared
constexpr int k_search_rounds = 14;
constexpr std::size_t k_rings = 20, k_rays = 96;
constexpr double k_reach = 3;   ///< radius of the outermost ring, in radii of a disc as large as the region
constexpr double k_deep = 0.4;  ///< distances are cut there, in the same unit
constexpr double k_starts_apart = 0.15, k_views_apart = 0.3;  ///< radians: poses nearer to each other are the same
constexpr double k_near_turn = 0.15;  ///< radians between the poses that are tried around a given one
constexpr std::size_t k_parts = 50;   ///< that a search is reported in
constexpr double k_pi = std::numbers::pi;

/// A region about its centroid in polar coordinates, whatever its size.
struct PolarShape {
    Vec2d center = Vec2d::Zero();
    double radius = 0;                                          ///< of a disc as large, pixels
    std::array<std::array<float, k_rays>, k_rings> distance{};  ///< signed, to its border, in that unit
};

PolarShape polar_shape(const PictureRegion& region) {
    PolarShape shape;
    double area = 0;
    for (int y = 0; y < region.mask.height; ++y)
        for (int x = 0; x < region.mask.width; ++x)
            if (region.mask.pixel(x, y)[0]) {
                shape.center += Vec2d(x + 0.5, y + 0.5);
                ++area;
            }
    if (area == 0) return shape;
    shape.center /= area;
    shape.radius = std::sqrt(area / k_pi);
    for (std::size_t ring = 0; ring < k_rings; ++ring)
        for (std::size_t ray = 0; ray < k_rays; ++ray) {
            const double r = shape.radius * k_reach * (static_cast<double>(ring) + 0.5) / k_rings;
            const double angle = 2 * k_pi * static_cast<double>(ray) / k_rays;
            const Vec2d place = shape.center + r * Vec2d(std::cos(angle), std::sin(angle));
            const double distance =
                static_cast<double>(distance_at(region.distance, place.cast<float>())) / shape.radius;
            shape.distance[ring][ray] = static_cast<float>(std::clamp(distance, -k_deep, k_deep));
        }
    return shape;
}

/// How much one shape differs from another that is turned by `turn` rays.
float difference(const PolarShape& shape, const PolarShape& other, std::size_t turn) {
    float sum = 0;
    for (std::size_t ring = 0; ring < k_rings; ++ring) {
        float squares = 0;
        for (std::size_t ray = 0; ray < k_rays; ++ray) {
            const std::size_t turned = ray + turn < k_rays ? ray + turn : ray + turn - k_rays;
            const float d = other.distance[ring][ray] - shape.distance[ring][turned];
            squares += d * d;
        }
        sum += squares * (static_cast<float>(ring) + 0.5f);  // the area that a ring stands for
    }
    return sum;
}

/// Directions spread evenly over the sphere (Fibonacci's lattice).
Vec3d direction_on_sphere(std::size_t i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / k_view_directions;
    const double angle = static_cast<double>(i) * k_pi * (3 - std::sqrt(5.0)), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

Eigen::Matrix3d axes_towards(const Vec3d& direction) {
    Eigen::Matrix3d axes;
    const Vec3d right = direction.unitOrthogonal();
    axes.row(0) = right;
    axes.row(1) = direction.cross(right);
    axes.row(2) = direction;
    return axes;
}

/// A pose to begin with, and how much its outline differs from what is sought.
struct Candidate {
    ViewPose pose;
    float difference = 0;
};

/// Returns the pose at a place in which the object looks most like the sought shape, for each of the best turns.
std::vector<Candidate> candidates_from(const TriangleMesh& mesh, const PoseFrame& frame, const PolarShape& sought,
                                       const Vec3d& direction, double distance) {
    const PoseFrame picture = frame.resized(k_picture, k_picture);
    ViewPose pose;
    pose.axes = axes_towards(direction);
    pose.distance = distance * frame.radius;
    pose.scale = 0.4 * k_picture / frame.radius;
    pose.place = Vec2d::Constant(0.5 * k_picture);
    const SeenRegion seen = seen_region(mesh, pose, picture, 0.8f * k_picture);
    if (seen.region.empty()) return {};
    const PolarShape shape = polar_shape(seen.region);
    std::array<float, k_rays> differences{};
    for (std::size_t turn = 0; turn < k_rays; ++turn) differences[turn] = difference(sought, shape, turn);
    std::vector<Candidate> candidates;
    for (std::size_t turn = 0; turn < k_rays; ++turn) {
        const float before = differences[(turn + k_rays - 1) % k_rays], after = differences[(turn + 1) % k_rays];
        if (differences[turn] > before || differences[turn] > after) continue;
        // A turn to the right in the picture, where y points down, is negative about the axis towards the eye.
        const double angle = 2 * k_pi * static_cast<double>(turn) / k_rays;
        const double zoom = sought.radius / shape.radius;
        ViewPose turned = pose;
        turned.axes = Eigen::AngleAxisd(-angle, Vec3d::UnitZ()) * pose.axes;
        turned.scale *= zoom;
        turned.place = sought.center + zoom * (Eigen::Rotation2Dd(angle) * (pose.place - shape.center));
        candidates.push_back({turned, differences[turn]});
    }
    return candidates;
}

/// Returns the best candidates that differ from each other.
std::vector<Candidate> apart(std::vector<Candidate> all) {
    std::ranges::stable_sort(all, {}, &Candidate::difference);
    std::vector<Candidate> chosen;
    for (const Candidate& candidate : all) {
        const auto same = [&](const Candidate& other) {
            return angle_between(candidate.pose, other.pose) < k_starts_apart &&
                   candidate.pose.distance == other.pose.distance;
        };
        if (chosen.size() < k_fitted_views && std::ranges::none_of(chosen, same)) chosen.push_back(candidate);
    }
    return chosen;
}

/// Fits all candidates to the region and returns the best that differ from each other; `step` is called k_parts times.
std::vector<RegionFit> best_fits(const TriangleMesh& mesh, const PoseFrame& frame, const PictureRegion& region,
                                 float size, const std::vector<Candidate>& candidates, std::size_t count,
                                 const std::function<void()>& step) {
    std::vector<RegionFit> fits(candidates.size());
    for (std::size_t part = 0; part < k_parts; ++part) {
        const std::size_t begin = part * fits.size() / k_parts, end = (part + 1) * fits.size() / k_parts;
        parallel_for(end - begin, [&](std::size_t i) {
            fits[begin + i] = fit_to_region(mesh, frame, candidates[begin + i].pose, region, size, k_search_rounds);
        });
        step();
    }
    std::ranges::stable_sort(fits, std::greater<>(), &RegionFit::overlap);
    std::vector<RegionFit> best;
    for (const RegionFit& fit : fits) {
        const auto same = [&](const RegionFit& other) { return angle_between(fit.pose, other.pose) < k_views_apart; };
        if (best.size() < count && std::ranges::none_of(best, same)) best.push_back(fit);
    }
    return best;
}

}  // namespace

std::vector<RegionFit> search_views(const TriangleMesh& mesh, const PoseFrame& frame, const PictureRegion& region,
                                    float size, std::size_t count, const std::function<void()>& step) {
    const PolarShape sought = polar_shape(region);
    std::vector<std::vector<Candidate>> found(k_view_directions * k_distances.size());
    for (std::size_t part = 0; part < k_parts; ++part) {
        const std::size_t begin = part * found.size() / k_parts, end = (part + 1) * found.size() / k_parts;
        parallel_for(end - begin, [&](std::size_t k) {
            const std::size_t i = begin + k;
            found[i] = candidates_from(mesh, frame, sought, direction_on_sphere(i / k_distances.size()),
                                       k_distances[i % k_distances.size()]);
        });
        step();
    }
    std::vector<Candidate> all;
    for (const auto& each : found) all.insert(all.end(), each.begin(), each.end());
    return best_fits(mesh, frame, region, size, apart(std::move(all)), count, step);
}

std::vector<RegionFit> search_near(const TriangleMesh& mesh, const PoseFrame& frame, const ViewPose& start,
                                   const PictureRegion& region, float size, std::size_t count,
                                   const std::function<void()>& step) {
    std::vector<Candidate> turned;
    for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y)
            for (int z = -2; z <= 2; ++z) {
                PoseChange change = PoseChange::Zero();
                change.head<3>() = k_near_turn * Vec3d(x, y, z);
                turned.push_back({changed(start, frame, change), 0});
            }
    for (std::size_t part = 0; part < k_parts; ++part) step();
    return best_fits(mesh, frame, region, size, turned, count, step);
}

}  // namespace exemplar
