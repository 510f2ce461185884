#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "host/hatching/features/pixel_features.h"
#include "host/hatching/features/powers.h"
#include "host/hatching/style/hatching_style.h"
#include "host/hatching/style/pixel_classifier.h"

namespace exemplar {
namespace {

/// "0.62 k_max,1 + 0.38 perp grad(L.N),2".
std::string describe(const OrientationFunction& function) {
    if (function.terms.empty()) return "no direction";
    std::string text;
    for (const auto& term : function.terms) {
        // A negative weight is that of the field turned by 90 degrees.
        const bool rotated = is_rotated(term.feature) != (term.weight < 0);
        const std::size_t feature = feature_of_field(field_of_feature(term.feature), rotated);
        text += fmt::format("{}{:.2f} {}", text.empty() ? "" : " + ", std::abs(term.weight),
                            orientation_feature_names()[feature]);
    }
    return text;
}

/// The features that stumps use most, with their share of the stumps.
std::string describe(const HatchingStyle& style, const CalibratedStumps& classifier) {
    std::map<std::uint32_t, std::size_t> counts;
    for (const Stump& stump : classifier.stumps.stumps) ++counts[stump.feature];
    std::vector<std::pair<std::size_t, std::uint32_t>> order;
    order.reserve(counts.size());
    for (const auto& [feature, count] : counts) order.emplace_back(count, feature);
    std::ranges::sort(order, std::ranges::greater{});
    std::string text;
    for (std::size_t k = 0; k < std::min<std::size_t>(order.size(), 5); ++k) {
        const double share = static_cast<double>(order[k].first) / static_cast<double>(classifier.stumps.stumps.size());
        text += fmt::format("{}{} ({:.0f}%)", k ? ", " : "", feature_name(style, order[k].second), 100 * share);
    }
    return text.empty() ? "nothing: it is the same everywhere" : text;
}

std::string describe(const HatchingStyle& style, const PropertyModel& model) {
    std::string text = fmt::format("{:.3g}", model.factor);
    for (const auto& term : model.terms)
        text += fmt::format(" * ({:.3g} {} {} {:.3g})^{:.2f}", term.a, feature_name(style, term.feature),
                            term.b < 0 ? "-" : "+", std::abs(term.b), term.exponent);
    return text;
}

}  // namespace

std::string feature_name(const HatchingStyle& style, std::uint32_t expanded) {
    const std::size_t base = expanded / k_powers;
    const auto name = [&] {
        if (base < k_pixel_features) return pixel_feature_names()[base];
        if (base < style.scalar_count()) return part_feature_name(style.parts[base - k_pixel_features]);
        return contextual_feature_names(style.rules.size()).at(base - style.scalar_count());
    };
    return name_of_power(name(), expanded % k_powers);
}

std::string describe_rule(const OrientationRule& rule) {
    std::string text = "hatches along " + describe(rule.function[0]);
    if (rule.crosses()) text += "; crossed along " + describe(rule.function[1]);
    return text;
}

std::string describe_hatching_style(const HatchingStyle& style) {
    std::string text =
        fmt::format("Hatching style of {}, a drawing of {} x {} pixels.\n", style.name, style.width, style.height);
    for (std::size_t c = 0; c < style.rules.size(); ++c) {
        text += fmt::format("Segment {} ({:.0f}% of the strokes): {}.\n", c + 1, 100 * style.share[c],
                            describe_rule(style.rules[c]));
    }
    if (style.rules.size() > 1)
        text += fmt::format("Segments are told by {}.\n", describe(style, style.segments.back()));
    text += fmt::format("Hatching levels are told by {}.\n", describe(style, style.levels));
    for (std::size_t p = 0; p < k_stroke_properties; ++p)
        text += fmt::format("{} = {}\n", name_of(static_cast<StrokeProperty>(p)), describe(style, style.properties[p]));
    constexpr float k_blunt = 1.5f;  // pixels; less cannot be told from none
    text += style.taper < k_blunt ? "Strokes end bluntly.\n"
                                  : fmt::format("Strokes end in points over {:.1f} pixels.\n", style.taper);
    if (style.outline_width > 0) text += fmt::format("Outlines are {:.1f} pixels wide.\n", style.outline_width);
    return text;
}

}  // namespace exemplar
