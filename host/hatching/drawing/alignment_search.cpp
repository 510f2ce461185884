#include "host/hatching/drawing/alignment_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlopt.hpp>
#include <numbers>

#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/statistics.h"

namespace exemplar {
namespace {

constexpr std::size_t k_points = 48;  ///< samples of a border, and of the inside
constexpr float k_search_outside_weight = 4;
constexpr float k_search_reach = 0.08f;  ///< of the object's size: distance at which misfit is truncated
constexpr float k_min_scale = 0.45f, k_max_scale = 1.5f, k_scale_step = 0.06f;
constexpr float k_tilt_step = 0.035f;        ///< radians, two degrees
constexpr float k_shift_step = 0.04f;        ///< of the object's size
constexpr int k_shifts = 8;                  ///< steps to either side
constexpr float k_search_tilt_cost = 0.02f;  ///< per radian: prefers the least rotated of equal placements
constexpr int k_evaluations = 250;

/// Scales and rotates about `center`, then moves it to `to`.
Similarity about(const Vec2& center, double scale, double rotation, const Vec2& to) {
    const Similarity turned(scale, rotation);
    const Vec2 shift = to - turned.apply(center);
    return turned.moved(static_cast<double>(shift.x()), static_cast<double>(shift.y()));
}

struct Place {
    Similarity to_object;
    float badness = std::numeric_limits<float>::max();
};

float badness_of(const RegionShape& drawing, const RegionShape& object, const Similarity& to_object) {
    return misfit(drawing, object, to_object, k_search_reach * object.size) +
           k_search_tilt_cost * static_cast<float>(std::abs(to_object.rotation()));
}

/// Returns the best placement of those with the same scale and rotation.
Place best_shift(const RegionShape& drawing, const RegionShape& object, double scale, double rotation) {
    Place best;
    const float step = k_shift_step * object.size;
    for (int dy = -k_shifts; dy <= k_shifts; ++dy)
        for (int dx = -k_shifts; dx <= k_shifts; ++dx) {
            const Vec2 to = object.center + step * Vec2(static_cast<float>(dx), static_cast<float>(dy));
            const Similarity s = about(drawing.center, scale, rotation, to);
            if (const float here = badness_of(drawing, object, s); here < best.badness) best = {s, here};
        }
    return best;
}

/// Returns roughly the max distance between the drawing's border in two placements.
float apart(const Similarity& a, const Similarity& b, const RegionShape& drawing) {
    float most = 0;
    for (std::size_t i = 0; i < drawing.border.size(); i += std::max<std::size_t>(1, drawing.border.size() / 8))
        most = std::max(most, (a.apply(drawing.border[i]) - b.apply(drawing.border[i])).norm());
    return most;
}

std::vector<std::array<double, 2>> scales_and_rotations(const SearchRange& range) {
    std::vector<std::array<double, 2>> all;
    const int tilts = static_cast<int>(std::ceil(range.max_tilt / k_tilt_step));
    const double tilt_step = tilts > 0 ? static_cast<double>(range.max_tilt) / tilts : 0;
    for (int turn = 0; turn < (range.quarter_turns ? 4 : 1); ++turn)
        for (int tilt = -tilts; tilt <= tilts; ++tilt)
            for (float scale = k_min_scale; scale < k_max_scale; scale *= 1 + k_scale_step)
                all.push_back({static_cast<double>(scale), turn * std::numbers::pi / 2 + tilt * tilt_step});
    return all;
}

}  // namespace

RegionShape region_shape(const PixelMask& region, const PixelMask& ink) {
    RegionShape shape;
    shape.border = border_points(region, 6 * k_points);
    Vec2 low = shape.border.front(), high = low;
    for (const Vec2& p : shape.border) low = low.cwiseMin(p), high = high.cwiseMax(p);
    shape.center = 0.5f * (low + high);
    shape.size = (high - low).maxCoeff() + 1;
    shape.distance = signed_distance(region);
    for (int y = 0; y < ink.height; ++y)
        for (int x = 0; x < ink.width; ++x)
            if (ink.pixel(x, y)[0]) shape.inside.push_back(center_of({x, y}));
    shape.inside = evenly_spaced(shape.inside, 6 * k_points);
    return shape;
}

float misfit(const RegionShape& drawing, const RegionShape& object, const Similarity& to_object, float reach) {
    const Similarity back = to_object.inverse();
    const auto in_object = static_cast<float>(to_object.scale());
    float there = 0, back_again = 0, outside = 0;
    for (const Vec2& p : drawing.border)
        there += std::min(std::abs(distance_at(object.distance, to_object.apply(p))), reach);
    for (const Vec2& p : object.border)
        back_again += std::min(in_object * std::abs(distance_at(drawing.distance, back.apply(p))), reach);
    for (const Vec2& p : drawing.inside)
        outside += std::clamp(distance_at(object.distance, to_object.apply(p)), 0.0f, reach);
    const auto mean = [&](float sum, const std::vector<Vec2>& points) {
        return points.empty() ? 0 : sum / (reach * static_cast<float>(points.size()));
    };
    return mean(there, drawing.border) + mean(back_again, object.border) +
           k_search_outside_weight * mean(outside, drawing.inside);
}

std::vector<Similarity> best_places(const RegionShape& drawing, const RegionShape& object, const SearchRange& range,
                                    std::size_t count) {
    RegionShape coarse = drawing, coarse_object = object;
    for (std::vector<Vec2>* points : {&coarse.border, &coarse.inside, &coarse_object.border})
        *points = evenly_spaced(*points, k_points);
    const std::vector<std::array<double, 2>> all = scales_and_rotations(range);
    std::vector<Place> places(all.size());
    parallel_for(all.size(),
                 [&](std::size_t i) { places[i] = best_shift(coarse, coarse_object, all[i][0], all[i][1]); });
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& a, const Place& b) { return a.badness < b.badness; });
    std::vector<Place> different;
    for (const Place& place : places) {
        const auto near = [&](const Place& other) {
            return apart(place.to_object, other.to_object, drawing) < k_search_reach * object.size;
        };
        if (different.size() < 3 * count && std::none_of(different.begin(), different.end(), near))
            different.push_back(place);
    }
    parallel_for(different.size(), [&](std::size_t i) {
        Place& place = different[i];
        const auto badness = [&](const Similarity& s) { return badness_of(drawing, object, s); };
        place.to_object =
            refined(place.to_object, object.center, 0.5f * object.size, k_shift_step * object.size, badness);
        place.badness = badness(place.to_object);
    });
    std::stable_sort(different.begin(), different.end(),
                     [](const Place& a, const Place& b) { return a.badness < b.badness; });
    std::vector<Similarity> best;
    for (const Place& place : different)
        if (best.size() < count) best.push_back(place.to_object);
    return best;
}

Similarity refined(const Similarity& start, const Vec2& center, float radius, float step,
                   const std::function<double(const Similarity&)>& badness) {
    const auto r = static_cast<double>(radius);
    struct Problem {
        const Similarity& start;
        Vec2 center;
        double radius;
        const std::function<double(const Similarity&)>& badness;
        Similarity at(const std::vector<double>& v) const {
            const Vec2 to = center + Vec2(static_cast<float>(v[2]), static_cast<float>(v[3]));
            return start.then(about(center, std::exp(v[0] / radius), v[1] / radius, to));
        }
    } problem{start, center, r, badness};
    nlopt::opt optimizer(nlopt::LN_SBPLX, 4);
    optimizer.set_initial_step(static_cast<double>(step));
    optimizer.set_maxeval(k_evaluations);
    optimizer.set_xtol_abs(0.005);
    const nlopt::vfunc objective = [](const std::vector<double>& v, std::vector<double>&, void* data) {
        const auto& p = *static_cast<const Problem*>(data);
        return p.badness(p.at(v));
    };
    optimizer.set_min_objective(objective, &problem);
    std::vector<double> v(4, 0.0);
    double value = 0;
    try {
        optimizer.optimize(v, value);
    } catch (const nlopt::roundoff_limited&) {
        // Smaller steps change nothing: the search has converged.
    }
    return problem.at(v);
}

}  // namespace exemplar
