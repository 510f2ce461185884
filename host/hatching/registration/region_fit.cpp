#include "host/hatching/registration/region_fit.h"

#include <algorithm>
#include <cmath>

#include "host/hatching/registration/pose_fit.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/region_outline.h"
#include "host/imaging/gbuffer.h"

namespace exemplar {
namespace {

constexpr float k_bay = 0.04f;  ///< of the size: radius that closes bays, as inked_region closes gaps between strokes
constexpr double k_region_scale = 0.04;  ///< of the size: gaps that count half

/// The gradient of a distance image: a unit vector, or zero where there is none.
Vec2d uphill(const FloatImage& distance, const Vec2& place) {
    const Vec2d gradient = distance_change(distance, place, 1).cast<double>();
    const double length = gradient.norm();
    return length > 0 ? Vec2d(gradient / length) : Vec2d(0, 0);
}

/// Matches the object's border with the nearest places on the region's, and the region's with the object's.
std::vector<LineMatch> region_matches(const SeenRegion& seen, const PictureRegion& region) {
    std::vector<LineMatch> matches;
    const FloatImage& there = region.distance;
    for (std::size_t i = 0; i < seen.points.size(); ++i)
        if (seen.valid[i])
            matches.push_back({seen.points[i], uphill(there, seen.region.border[i]),
                               -static_cast<double>(distance_at(there, seen.region.border[i]) + 0.5f)});
    for (const Vec2& place : region.border) {
        const auto nearest = std::ranges::min_element(seen.region.border, {},
                                                      [&](const Vec2& other) { return (other - place).squaredNorm(); });
        const auto i = static_cast<std::size_t>(nearest - seen.region.border.begin());
        if (seen.valid[i])
            matches.push_back({seen.points[i], uphill(seen.region.distance, place),
                               static_cast<double>(distance_at(seen.region.distance, place) + 0.5f)});
    }
    return matches;
}

}  // namespace

PictureRegion picture_region(const PixelMask& mask, float size) {
    PictureRegion region;
    region.mask = without_holes(closed_region(mask, k_bay * size));
    region.distance = signed_distance(region.mask);
    region.border = border_points(region.mask, k_region_points);
    return region;
}

SeenRegion seen_region(const TriangleMesh& mesh, const ViewPose& pose, const PoseFrame& frame, float size) {
    const GBuffer gbuffer = render_gbuffer(mesh, pose_camera(pose, frame), frame.width, frame.height);
    PixelMask mask(frame.width, frame.height, 1);
    for (std::size_t i = 0; i < mask.data.size(); ++i) mask.data[i] = std::isfinite(gbuffer.depth[i]);
    SeenRegion seen{picture_region(mask, size), {}, {}};
    for (const Vec2& place : seen.region.border) {
        const float depth = gbuffer.depth[gbuffer.index(static_cast<int>(place.x()), static_cast<int>(place.y()))];
        seen.valid.push_back(std::isfinite(depth));
        seen.points.push_back(std::isfinite(depth)
                                  ? unprojected(pose, frame, place.cast<double>(), static_cast<double>(depth))
                                  : frame.center);
    }
    return seen;
}

double overlap_of(const PixelMask& first, const PixelMask& second) {
    double both = 0, either = 0;
    for (std::size_t i = 0; i < first.data.size(); ++i) {
        both += first.data[i] && second.data[i];
        either += first.data[i] || second.data[i];
    }
    return either > 0 ? both / either : 0;
}

RegionFit fit_to_region(const TriangleMesh& mesh, const PoseFrame& frame, const ViewPose& start,
                        const PictureRegion& region, float size, int rounds) {
    RegionFit best{start, 0};
    ViewPose pose = start;
    for (int round = 0; round <= rounds; ++round) {
        const SeenRegion seen = seen_region(mesh, pose, frame, size);
        if (seen.region.empty()) break;
        if (const double overlap = overlap_of(seen.region.mask, region.mask); overlap > best.overlap)
            best = {pose, overlap};
        const double scale = std::max(1.0, k_region_scale * static_cast<double>(size));
        pose = changed(pose, frame, fitting_change(pose, frame, region_matches(seen, region), scale));
    }
    return best;
}

}  // namespace exemplar
