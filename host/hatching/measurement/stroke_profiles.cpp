#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "host/hatching/measurement/along_stroke.h"
#include "host/hatching/measurement/stroke_properties.h"

namespace exemplar {
namespace {

constexpr float k_reach_along = 4;   ///< pixels before and behind a point that its profile takes in
constexpr float k_paper_beside = 2;  ///< pixels of paper on either side that a profile takes in
constexpr std::size_t k_min_inside = 4, k_min_outside = 3;  ///< min samples in the stroke, and on either side
constexpr float k_min_width = 1;         ///< pixels: narrower strokes look like lighter ones of this width
constexpr float k_min_fit_width = 0.4f;  ///< pixels: keeps the fit from dividing by nothing
constexpr int k_profile_steps = 8;
constexpr float k_noise = 0.03f;        ///< of darkness: weighs samples against the priors below
constexpr float k_likely_turn = 0.1f;   ///< radians by which a point's orientation may be wrong
constexpr float k_likely_bend = 0.02f;  ///< 1 / pixels: half the curvature of an arc of radius 25
constexpr float k_longest_bridge = 8;   ///< max gap, in widths, over which a center line is straight
constexpr std::size_t k_softness_points = 400;
constexpr float k_better = 0.98f;   ///< max misfit, relative to that of sharp edges, to accept softness
constexpr float k_black = 0.7f;     ///< darkness from which ink is black
constexpr double k_as_good = 1.05;  ///< max misfit, relative to the best softness, that may be chance
constexpr std::array<float, 10> k_softnesses{0, 0.25f, 0.4f, 0.55f, 0.7f, 0.85f, 1, 1.25f, 1.5f, 2};

/// The profile of a straight edge: the share of a pixel, at a distance from the edge, that the inked side covers,
/// blurred.
class SoftEdge {
  public:
    explicit SoftEdge(float softness) : reach_(0.5f + 4 * softness) {
        const std::size_t count = 2 * static_cast<std::size_t>(std::ceil(reach_ * k_per_pixel)) + 2;
        for (std::size_t i = 0; i < count; ++i)
            table_.push_back(exact(static_cast<double>(i) / k_per_pixel - reach_, softness));
    }

    struct Value {
        float cover = 0, slope = 0;
    };
    /// At a distance inside (positive) or outside (negative) of the edge.
    Value at(float distance) const {
        const float place = (distance + reach_) * k_per_pixel;
        if (place <= 0) return {0, 0};
        const auto i = static_cast<std::size_t>(place);
        if (i + 1 >= table_.size()) return {1, 0};
        const float share = place - static_cast<float>(i);
        return {std::lerp(table_[i].cover, table_[i + 1].cover, share),
                std::lerp(table_[i].slope, table_[i + 1].slope, share)};
    }

  private:
    static constexpr float k_per_pixel = 32;

    static Value exact(double x, double softness) {
        if (softness < 0.02)
            return {static_cast<float>(std::clamp(x + 0.5, 0.0, 1.0)), std::abs(x) < 0.5 ? 1.0f : 0.0f};
        const auto below = [](double t) { return 0.5 * std::erfc(-t / std::numbers::sqrt2); };
        const auto integral = [&](double t) {
            return t * below(t) + std::exp(-0.5 * t * t) / std::sqrt(2 * std::numbers::pi);
        };
        const double right = (x + 0.5) / softness, left = (x - 0.5) / softness;
        return {static_cast<float>(softness * (integral(right) - integral(left))),
                static_cast<float>(below(right) - below(left))};
    }

    float reach_;
    std::vector<Value> table_;
};

/// A pixel in the frame of a point of a stroke: along it, across it (to its right), and its darkness above the
/// paper's.
struct Sample {
    float along, across, darkness;
};

/// The drawing, and the assignment of its pixels to strokes.
struct Surroundings {
    const FloatImage& darkness;
    float paper;
    const StrokeMap& map;
    const PixelMask& crossing_pixels;
};

void collect(const Surroundings& around, const TracedPoint& point, PointId id, float width,
             std::vector<Sample>& samples) {
    const float reach_across = 0.5f * width + k_paper_beside;
    const int reach = static_cast<int>(std::ceil(std::hypot(k_reach_along, reach_across)));
    const Vec2 along(std::cos(point.orientation), std::sin(point.orientation)), across(-along.y(), along.x());
    const auto [cx, cy] = around.map.pixel_of(point);
    samples.clear();
    for (int y = std::max(0, cy - reach); y <= std::min(around.darkness.height - 1, cy + reach); ++y)
        for (int x = std::max(0, cx - reach); x <= std::min(around.darkness.width - 1, cx + reach); ++x) {
            const Vec2 way = center_of({x, y}) - point.center;
            const Sample sample{along.dot(way), across.dot(way), around.darkness.pixel(x, y)[0] - around.paper};
            if (std::abs(sample.along) > k_reach_along || std::abs(sample.across) > reach_across ||
                around.crossing_pixels.pixel(x, y)[0])
                continue;
            const PointId nearest = around.map.nearest(x, y);
            if (nearest.stroke == id.stroke && std::abs(nearest.point - id.point) <= 2 * reach)
                samples.push_back(sample);
        }
}

bool enough(std::span<const Sample> samples, float width) {
    std::size_t inside = 0, left = 0, right = 0;
    for (const Sample& s : samples) {
        inside += std::abs(s.across) < 0.5f * width;
        left += s.across < -0.5f * width - 0.3f;
        right += s.across > 0.5f * width + 0.3f;
    }
    return inside >= k_min_inside && left >= k_min_outside && right >= k_min_outside;
}

/// The model of a stroke near one of its points. Its center line is offset + turn * along + bend * along^2 across.
/// The thesis takes the distance to the nearest lighter pixel: half of the thickness, give or take a pixel. And a
/// pixel half covered is not a stroke half as dark.
struct Profile {
    float ink = 0;  ///< darkness times width
    float width = 0, offset = 0, turn = 0, bend = 0;
    float misfit = 0;  ///< root of the mean squared difference

    float darkness() const { return ink / width; }
};

using Parameters = Eigen::Matrix<float, 5, 1>;

/// Returns the modeled darkness of a sample, and its derivatives by (ink, width, offset, turn, bend).
float predict(const Profile& p, const Sample& s, const SoftEdge& edge, Parameters& change) {
    const float across = s.across - (p.offset + s.along * (p.turn + s.along * p.bend));
    const SoftEdge::Value right = edge.at(0.5f * p.width - across), left = edge.at(-0.5f * p.width - across);
    const float shape = right.cover - left.cover, dark = p.darkness();
    const float shift = dark * (right.slope - left.slope);
    change << shape / p.width, dark * (0.5f * (right.slope + left.slope) - shape / p.width), shift, shift * s.along,
        shift * s.along * s.along;
    return dark * shape;
}

/// Does one Gauss-Newton step; returns its length in pixels.
float improve(std::span<const Sample> samples, const SoftEdge& edge, Profile& p) {
    Eigen::Matrix<float, 5, 5> normal = Eigen::Matrix<float, 5, 5>::Zero();
    Parameters right = Parameters::Zero(), change;
    for (const Sample& s : samples) {
        const float rest = s.darkness - predict(p, s, edge, change);
        normal += change * change.transpose();
        right += rest * change;
    }
    const auto likely = [](float size) { return k_noise * k_noise / (size * size); };
    const Parameters prior(1e-4f, 1e-4f, likely(0.5f * p.width), likely(k_likely_turn), likely(k_likely_bend));
    normal.diagonal() += prior;
    right -= Parameters(0, 0, prior[2] * p.offset, prior[3] * p.turn, prior[4] * p.bend);
    Parameters step = normal.ldlt().solve(right);
    if (!step.allFinite()) return 0;
    const float most = 0.5f * p.width, size = std::max(std::abs(step[1]), std::abs(step[2]));
    if (size > most) step *= most / size;
    p.ink = std::max(p.ink + step[0], 1e-3f);
    p.width = std::max(p.width + step[1], k_min_fit_width);
    p.offset += step[2], p.turn += step[3], p.bend += step[4];
    return std::min(size, most);
}

Profile fit_profile(std::span<const Sample> samples, const SoftEdge& edge, float width) {
    Profile profile;
    profile.width = std::max(width, k_min_width);
    float darkest = 0;
    for (const Sample& s : samples) darkest = std::max(darkest, s.darkness);
    profile.ink = darkest * profile.width;
    for (int step = 0; step < k_profile_steps; ++step)
        if (improve(samples, edge, profile) < 0.01f) break;
    Parameters change;
    float sum = 0;
    for (const Sample& s : samples) sum += std::pow(s.darkness - predict(profile, s, edge, change), 2.0f);
    profile.misfit = std::sqrt(sum / static_cast<float>(samples.size()));
    return profile;
}

/// Stores a profile in its point if its width and offset are plausible for the stroke's mask. Returns whether they
/// are.
bool accept(const Profile& profile, float paper, const TracedStroke& stroke, TracedPoint& point) {
    if (profile.width > 2 * stroke.width + 2 || std::abs(profile.offset) > 0.5f * stroke.width + 1) return false;
    const float ink = profile.ink;
    point.thickness = std::max(profile.width, k_min_width);
    point.intensity = ink / point.thickness + paper;
    if (point.intensity > 1) point.intensity = 1, point.thickness = ink / (1 - paper);
    const Vec2 across(-std::sin(point.orientation), std::cos(point.orientation));
    point.center += profile.offset * across;
    return true;
}

/// Interpolates thickness, intensity and, at crossings, the center of points that were not measured between the
/// nearest measured ones of the stroke. Returns whether there are any measured ones.
bool fill_along(TracedStroke& stroke) {
    const auto longest = static_cast<std::size_t>(k_longest_bridge * std::max(stroke.width, 1.0f));
    std::vector<bool> measured;
    for (const TracedPoint& point : stroke.points) measured.push_back(point.profiled);
    for_each_unmeasured(measured, [&](std::size_t i, const MeasuredNeighbors& b) {
        const TracedPoint &before = stroke.points[b.before], &behind = stroke.points[b.behind];
        stroke.points[i].thickness = std::lerp(before.thickness, behind.thickness, b.share);
        stroke.points[i].intensity = std::lerp(before.intensity, behind.intensity, b.share);
        if (stroke.points[i].at_crossing && b.before != b.behind && b.behind - b.before <= longest)
            stroke.points[i].center = before.center + b.share * (behind.center - before.center);
    });
    return std::find(measured.begin(), measured.end(), true) != measured.end();
}

/// Gives strokes too crowded for any profile the median values of the drawing, or, if there are none, values from
/// masks and pixels.
void fill_others(const FloatImage& darkness, const StrokeMap& map, const std::vector<std::uint8_t>& filled,
                 std::span<TracedStroke> strokes) {
    std::vector<float> thickness, intensity;
    for (const TracedStroke& stroke : strokes)
        for (const TracedPoint& point : stroke.points)
            if (point.profiled) thickness.push_back(point.thickness), intensity.push_back(point.intensity);
    const bool any = !thickness.empty();
    const float usual_thickness = any ? upper_median(thickness) : 0,
                usual_intensity = any ? upper_median(intensity) : 0;
    for (std::size_t s = 0; s < strokes.size(); ++s) {
        if (filled[s]) continue;
        for (TracedPoint& point : strokes[s].points) {
            const auto [x, y] = map.pixel_of(point);
            point.thickness = any ? usual_thickness : std::max(strokes[s].width, k_min_width);
            point.intensity = any ? usual_intensity : std::clamp(darkness.pixel(x, y)[0], 1.0f / 255, 1.0f);
        }
    }
}

/// Selects about k_softness_points points, evenly over all strokes.
std::vector<PointId> spread_points(std::span<const TracedStroke> strokes) {
    std::vector<PointId> all, some;
    for (std::size_t s = 0; s < strokes.size(); ++s)
        for (std::size_t p = 0; p < strokes[s].points.size(); ++p)
            if (!strokes[s].points[p].at_crossing)
                all.push_back({static_cast<std::int32_t>(s), static_cast<std::int32_t>(p)});
    const std::size_t stride = std::max<std::size_t>(1, all.size() / k_softness_points);
    for (std::size_t i = stride / 2; i < all.size(); i += stride) some.push_back(all[i]);
    return some;
}

/// Medians over profiles that were fitted with a softness.
struct SoftnessFit {
    float softness = 0;
    double misfit = 0;
    float darkness = 0;
};

SoftnessFit fit_softness(const std::vector<std::vector<Sample>>& profiles, std::span<const float> widths,
                         float softness) {
    const SoftEdge edge(softness);
    std::vector<float> misfits(profiles.size(), 0), darkness(profiles.size(), 0);
    parallel_for(
        profiles.size(),
        [&](std::size_t i) {
            const Profile profile = fit_profile(profiles[i], edge, widths[i]);
            misfits[i] = profile.misfit;
            darkness[i] = profile.darkness();
        },
        8);
    return {softness, upper_median(misfits), upper_median(darkness)};
}

/// Returns the softness at the lowest point of the parabola through the misfits of three fits.
float lowest(const std::array<SoftnessFit, 3>& fits) {
    const auto slope = [&](std::size_t i) {
        return (fits[i + 1].misfit - fits[i].misfit) / static_cast<double>(fits[i + 1].softness - fits[i].softness);
    };
    const double curvature = (slope(1) - slope(0)) / static_cast<double>(fits[2].softness - fits[0].softness);
    if (!(curvature > 0)) return fits[1].softness;
    return static_cast<float>(0.5 * (static_cast<double>(fits[0].softness + fits[1].softness) - slope(0) / curvature));
}

/// Returns whether the ink is black: whether the darkest places on strokes are, which are wide, or where strokes cross.
bool is_black_ink(const FloatImage& darkness, const StrokeMap& map, std::span<const TracedStroke> strokes) {
    std::vector<float> values;
    for (const TracedStroke& stroke : strokes) {
        for (const TracedPoint& point : stroke.points) {
            const auto [x, y] = map.pixel_of(point);
            values.push_back(darkness.pixel(x, y)[0]);
        }
    }
    return quantile(values, 0.999) > k_black;
}

/// Returns the largest softness from fit number `best` on, which fits best, that fits about as well. Strokes that are
/// hardly wider than the blur fit as narrow black ones, blurred, about as well as they do as wide gray ones.
float darkest_softness(std::span<const SoftnessFit> fits, std::size_t best, float darkest) {
    const double limit = k_as_good * fits[best].misfit;
    for (std::size_t i = best; i + 1 < fits.size(); ++i) {
        const SoftnessFit &from = fits[i], &to = fits[i + 1];
        double share = 1;
        if (to.misfit > limit) share = (limit - from.misfit) / (to.misfit - from.misfit);
        if (to.darkness > darkest)
            share = std::min<double>(share, (darkest - from.darkness) / (to.darkness - from.darkness));
        if (share < 1) return std::lerp(from.softness, to.softness, std::max(0.0f, static_cast<float>(share)));
    }
    return fits.back().softness;
}

}  // namespace

float estimate_softness(const FloatImage& darkness, float paper, const StrokeMap& map, const PixelMask& crossing_pixels,
                        std::span<const TracedStroke> strokes) {
    std::vector<std::vector<Sample>> profiles;
    std::vector<float> widths;
    std::vector<Sample> samples;
    for (const PointId id : spread_points(strokes)) {
        const TracedStroke& stroke = strokes[id.stroke];
        collect({darkness, paper, map, crossing_pixels}, stroke.points[id.point], id, stroke.width, samples);
        if (!enough(samples, stroke.width)) continue;
        profiles.push_back(samples);
        widths.push_back(stroke.width);
    }
    if (profiles.empty()) return 0;
    std::vector<SoftnessFit> fits;
    fits.reserve(k_softnesses.size());
    for (const float softness : k_softnesses) fits.push_back(fit_softness(profiles, widths, softness));
    const auto best = static_cast<std::size_t>(std::ranges::min_element(fits, {}, &SoftnessFit::misfit) - fits.begin());
    if (best == 0 || !(fits[best].misfit <= k_better * fits[0].misfit)) return 0;
    if (is_black_ink(darkness, map, strokes)) return darkest_softness(fits, best, 1 - paper);
    if (best + 1 == fits.size()) return fits[best].softness;
    return lowest({fits[best - 1], fits[best], fits[best + 1]});
}

void measure_profiles(const FloatImage& darkness, float paper, float softness, const StrokeMap& map,
                      const PixelMask& crossing_pixels, std::span<TracedStroke> strokes) {
    const SoftEdge edge(softness);
    const Surroundings around{darkness, paper, map, crossing_pixels};
    std::vector<std::uint8_t> filled(strokes.size(), 0);
    parallel_for(
        strokes.size(),
        [&](std::size_t s) {
            TracedStroke& stroke = strokes[s];
            std::vector<Sample> samples;
            for (std::size_t i = 0; i < stroke.points.size(); ++i) {
                TracedPoint& point = stroke.points[i];
                if (point.at_crossing) continue;
                collect(around, point, {static_cast<std::int32_t>(s), static_cast<std::int32_t>(i)}, stroke.width,
                        samples);
                if (enough(samples, stroke.width))
                    point.profiled = accept(fit_profile(samples, edge, stroke.width), paper, stroke, point);
            }
            filled[s] = fill_along(stroke);
            orient_along(stroke);
        },
        8);
    fill_others(darkness, map, filled, strokes);
}

}  // namespace exemplar
