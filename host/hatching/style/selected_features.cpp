#include "host/hatching/style/selected_features.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "host/hatching/features/pixel_features.h"
#include "host/hatching/features/powers.h"

namespace exemplar {
namespace {

constexpr std::size_t k_first = 3;

struct NamedType {
    std::string_view prefix, type;
};

// The first prefix that fits a name tells its type.
constexpr std::array<NamedType, 16> k_orientation_types{{{"k_m", "k_max, k_min"},
                                                         {"e_", "e_a, e_b"},
                                                         {"LxN", "L x N"},
                                                         {"VxN", "V x N"},
                                                         {"L", "light"},
                                                         {"E", "irradiance"},
                                                         {"s", "suggestive contours"},
                                                         {"r", "ridges"},
                                                         {"v", "valleys"},
                                                         {"grad V.N", "grad V.N"},
                                                         {"grad L.N", "grad L.N"},
                                                         {"grad a", "grad a"},
                                                         {"grad I", "grad I"},
                                                         {"UxN", "U x N"},
                                                         {"x", "of the picture"},
                                                         {"diagonal", "of the picture"}}};
constexpr std::array<NamedType, 24> k_scalar_types{{{"curvature.radial", "radial curvature"},
                                                    {"curvature.d_radial", "derivative of radial curvature"},
                                                    {"curvature.torsion", "torsion"},
                                                    {"curvature.c", "derivatives of curvature"},
                                                    {"curvature.", "curvature"},
                                                    {"pca.", "PCA"},
                                                    {"shape_context.", "shape contexts"},
                                                    {"geodesic.", "geodesic distance"},
                                                    {"diameter.", "shape diameter"},
                                                    {"medial.", "distance from medial surface"},
                                                    {"image.depth", "depth"},
                                                    {"image.grad a", "ambient occlusion"},
                                                    {"image.a", "ambient occlusion"},
                                                    {"image.grad", "gradients of I, V.N, L.N"},
                                                    {"image.curvature", "curvatures of I, V.N, L.N"},
                                                    {"image.I", "I"},
                                                    {"image.V.N", "V.N"},
                                                    {"image.L.N", "L.N"},
                                                    {"lines.contours", "contours, suggestive contours"},
                                                    {"lines.ridges", "ridges, valleys"},
                                                    {"lines.valleys", "ridges, valleys"},
                                                    {"lines.apparent", "apparent ridges"},
                                                    {"part.", "labels of parts"},
                                                    {"context.", "contextual labels"}}};

std::string type_of(std::string name, std::span<const NamedType> types) {
    std::erase(name, '|');  // of a magnitude
    const auto fits = [&](const NamedType& type) { return name.starts_with(type.prefix); };
    const auto found = std::ranges::find_if(types, fits);
    return std::string(found == types.end() ? "other" : found->type);
}

std::string orientation_type(std::uint32_t feature) {
    return type_of(orientation_feature_names()[feature_of_field(field_of_feature(feature))], k_orientation_types);
}

std::string scalar_type(const HatchingStyle& style, std::uint32_t expanded) {
    const auto first_power = static_cast<std::uint32_t>(expanded - expanded % k_powers);
    return type_of(feature_name(style, first_power), k_scalar_types);
}

/// Returns the types of the first features that differ.
std::vector<std::string> first_types(const HatchingStyle& style, std::span<const std::uint32_t> selected) {
    std::set<std::uint32_t> seen;
    std::vector<std::string> types;
    for (const std::uint32_t expanded : selected) {
        if (types.size() == k_first) break;
        if (seen.insert(expanded).second) types.push_back(scalar_type(style, expanded));
    }
    return types;
}

std::vector<std::uint32_t> selected_by(const CalibratedStumps& classifier) {
    std::vector<std::uint32_t> selected;
    for (const Stump& stump : classifier.stumps.stumps) selected.push_back(stump.feature);
    return selected;
}

std::vector<std::uint32_t> selected_for(const HatchingStyle& style, FeatureUse use) {
    // The rough classifier of levels chooses among all features in every round.
    if (use == FeatureUse::level)
        return selected_by(style.rough_levels.stumps.stumps.empty() ? style.levels : style.rough_levels);
    if (use == FeatureUse::segment)
        return style.segments.empty() ? std::vector<std::uint32_t>{} : selected_by(style.segments.front());
    std::vector<std::uint32_t> selected;
    const std::size_t property = static_cast<std::size_t>(use) - static_cast<std::size_t>(FeatureUse::thickness);
    for (const auto& term : style.properties[property].terms)
        selected.push_back(static_cast<std::uint32_t>(term.feature));
    return selected;
}

/// Adds the types of a style's rules, weighted by the strokes of their segments.
void add_rules(const HatchingStyle& style, std::map<std::string, double>& shares) {
    for (std::size_t c = 0; c < style.rules.size(); ++c) {
        for (const OrientationFunction& function : style.rules[c].function) {
            const std::size_t count = std::min(k_first, function.terms.size());
            for (std::size_t k = 0; k < count; ++k)
                shares[orientation_type(static_cast<std::uint32_t>(function.terms[k].feature))] += style.share[c];
        }
    }
}

void normalize(std::map<std::string, double>& shares) {
    double sum = 0;
    for (const auto& [type, share] : shares) sum += share;
    for (auto& [type, share] : shares) share /= sum;
}

}  // namespace

const char* name_of(FeatureUse use) {
    constexpr std::array<const char*, k_feature_uses> k_names{"orientation", "level",  "thickness", "intensity",
                                                              "spacing",     "length", "segment"};
    return k_names[static_cast<std::size_t>(use)];
}

std::map<std::string, double> selected_features(std::span<const HatchingStyle> styles, FeatureUse use) {
    std::map<std::string, double> all;
    for (const HatchingStyle& style : styles) {
        std::map<std::string, double> shares;
        if (use == FeatureUse::orientation)
            add_rules(style, shares);
        else
            for (const std::string& type : first_types(style, selected_for(style, use))) shares[type] += 1;
        normalize(shares);
        for (const auto& [type, share] : shares) all[type] += share;
    }
    normalize(all);
    return all;
}

}  // namespace exemplar
