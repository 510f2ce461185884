#include "host/synth/hatching/hatching_rules.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "host/core/errors.h"

namespace exemplar {
namespace {

constexpr std::array<std::string_view, 4> k_rule_names{"contour", "light", "parts", "flow"};

/// The hatching at a pixel; lengths are for pictures of 1000 pixels.
struct Targets {
    std::uint8_t level = 0;
    std::array<DoubledAngle, k_hatch_layers> direction{};
    float thickness = 2, intensity = 1, spacing = 8, length = 60;
};

/// Named features of the pixels of a view.
class NamedFeatures {
  public:
    NamedFeatures(PixelFeatures& pixels, std::span<const char* const> scalars)
        : scalars_(pixels.scalars(numbers_of(scalars), {})), directions_(pixels.orientations({})) {}
    /// Returns the k-th of the scalars.
    float operator()(std::size_t k, std::size_t row) const { return scalars_.column(k)[row]; }
    DoubledAngle direction(std::string_view name, std::size_t row) const {
        const auto& names = orientation_feature_names();
        return directions_.feature(static_cast<std::size_t>(std::ranges::find(names, name) - names.begin()), row);
    }

  private:
    static std::vector<std::uint32_t> numbers_of(std::span<const char* const> scalars) {
        std::vector<std::uint32_t> numbers;
        const auto& names = pixel_feature_names();
        for (const char* name : scalars)
            numbers.push_back(static_cast<std::uint32_t>(std::ranges::find(names, name) - names.begin()));
        return numbers;
    }
    FeatureMatrix scalars_;
    OrientationFields directions_;
};

DoubledAngle mixed(float share, const DoubledAngle& a, const DoubledAngle& b) {
    return normalized({share * a[0] + (1 - share) * b[0], share * a[1] + (1 - share) * b[1]});
}

/// A style: the scalar features it reads, and the function from features to targets.
struct Rule {
    std::vector<const char*> scalars;
    std::function<Targets(const NamedFeatures&, std::size_t)> at;
};

Rule contour_rule() {
    return {{"image.I@3"}, [](const NamedFeatures& of, std::size_t row) {
                const float light = std::clamp(of(0, row), 0.0f, 1.0f);
                Targets t;
                t.level = light < 0.35f ? 2 : light < 0.75f ? 1 : 0;
                t.direction = {of.direction("k_max,2", row), of.direction("k_min,2", row)};
                t.spacing = 6 + 5 * light;
                t.thickness = 1.6f + 1.4f * (1 - light);
                t.intensity = 0.95f;
                t.length = 45;
                return t;
            }};
}

Rule light_rule() {
    return {{"image.L.N@2", "image.a@3", "image.I@2", "image.V.N@3"}, [](const NamedFeatures& of, std::size_t row) {
                Targets t;
                t.level = of(1, row) < 0.9f ? 2 : of(0, row) < 0.7f ? 1 : 0;
                t.direction = {of.direction("grad L.N,3", row), of.direction("perp grad L.N,3", row)};
                t.spacing = 5.5f + 6 * of(0, row);
                t.thickness = 2;
                t.intensity = 0.5f + 0.45f * (1 - std::clamp(of(2, row), 0.0f, 1.0f));
                t.length = 20 + 20 * of(3, row);
                return t;
            }};
}

Rule parts_rule() {
    return {{"diameter.mean@90", "image.L.N@3", "image.V.N@2", "curvature.|mean|@0.05"},
            [](const NamedFeatures& of, std::size_t row) {
                const float tone = 0.6f * of(1, row) + 0.4f * of(2, row);
                Targets t;
                const bool thick = of(0, row) > 0.3f;
                t.level = thick && tone < 0.45f ? 2 : tone < 0.8f ? 1 : 0;
                t.direction = {of.direction(thick ? "e_a,3" : "k_max,2", row), of.direction("perp e_a,3", row)};
                t.spacing = thick ? 9.0f : 7.0f;
                t.thickness = std::min(1.5f + 0.25f * of(3, row), 3.5f);
                t.intensity = 0.85f;
                t.length = thick ? 50.0f : 25.0f;
                return t;
            }};
}

Rule flow_rule() {
    return {{"image.V.N@2", "image.depth", "image.I@5"}, [](const NamedFeatures& of, std::size_t row) {
                Targets t;
                t.level = of(2, row) < 0.85f ? 1 : 0;
                t.direction[0] = mixed(0.6f, of.direction("VxN", row), of.direction("e_a,3", row));
                t.spacing = 5 + 4 * of(0, row);
                t.thickness = 1.5f + 1.2f * (1 - of(0, row));
                t.intensity = std::clamp(0.7f - 0.35f * of(1, row), 0.3f, 1.0f);
                t.length = 50;
                return t;
            }};
}

Rule rule_of(std::string_view style) {
    if (style == "contour") return contour_rule();
    if (style == "light") return light_rule();
    if (style == "parts") return parts_rule();
    if (style == "flow") return flow_rule();
    throw UsageError(
        fmt::format("'{}' is no built-in hatching style; there are: {}", style, fmt::join(k_rule_names, ", ")));
}

}  // namespace

std::span<const std::string_view> hatching_rule_names() {
    return k_rule_names;
}

HatchingFields hatching_by_rule(std::string_view style, PixelFeatures& pixels) {
    const Rule rule = rule_of(style);
    const NamedFeatures features(pixels, rule.scalars);
    const HatchingView& view = pixels.view();
    // A picture could not show finer strokes.
    constexpr float k_min_scale = 0.7f;
    const float scale = std::max(static_cast<float>(std::min(view.width, view.height)) / 1000, k_min_scale);
    HatchingFields out(view.width, view.height);
    for (std::size_t row = 0; row < pixels.size(); ++row) {
        const Targets t = rule.at(features, row);
        const std::uint32_t p = pixels.pixels().pixel[row];
        // A layer without a defined direction is not drawn.
        std::uint8_t level = t.level;
        if (t.direction[1] == DoubledAngle{}) level = std::min(level, k_single_hatching);
        if (t.direction[0] == DoubledAngle{}) level = k_no_hatching;
        out.level[p] = level;
        for (std::size_t layer = 0; layer < k_hatch_layers; ++layer)
            out.orientation[layer][p] = angle_of(t.direction[layer]);
        out.thickness[p] = scale * t.thickness;
        out.intensity[p] = t.intensity;
        out.spacing[p] = scale * t.spacing;
        out.length[p] = scale * t.length;
    }
    return out;
}

}  // namespace exemplar
