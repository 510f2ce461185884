#include "host/hatching/style/selected_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "host/hatching/features/pixel_features.h"
#include "host/hatching/features/powers.h"

namespace exemplar {
namespace {

std::uint32_t orientation_feature(const std::string& name) {
    const auto& names = orientation_feature_names();
    return static_cast<std::uint32_t>(std::ranges::find(names, name) - names.begin());
}

std::uint32_t expanded_feature(const std::string& name, std::size_t power = 0) {
    const auto& names = pixel_feature_names();
    return static_cast<std::uint32_t>(
        k_powers * static_cast<std::size_t>(std::ranges::find(names, name) - names.begin()) + power);
}

HatchingStyle with_levels(const std::vector<std::uint32_t>& features) {
    HatchingStyle style;
    for (const std::uint32_t feature : features) style.levels.stumps.stumps.push_back({feature, 0, 1, -1, 1});
    return style;
}

TEST(SelectedFeatures, WeighRulesByTheStrokesOfTheirSegments) {
    HatchingStyle style;
    style.rules.resize(2);
    style.rules[0].function[0].terms = {{orientation_feature("k_max,2"), 1.0f},
                                        {orientation_feature("perp LxN"), 1.0f}};
    style.rules[1].function[0].terms = {{orientation_feature("perp k_min,1"), 1.0f}};
    style.rules[1].function[1].terms = {{orientation_feature("UxN"), 1.0f}};
    style.share = {0.75, 0.25};
    const std::map<std::string, double> expected{{"k_max, k_min", 0.5}, {"L x N", 0.375}, {"U x N", 0.125}};
    EXPECT_EQ(selected_features(std::span(&style, 1), FeatureUse::orientation), expected);
}

TEST(SelectedFeatures, AreTheFirstThreeThatDiffer) {
    const std::uint32_t pca = expanded_feature("pca.s1@0.2"), light = expanded_feature("image.L.N@5"),
                        square = expanded_feature("curvature.|radial|@0.01", 1), late = expanded_feature("image.depth");
    const std::vector<HatchingStyle> styles{with_levels({pca, pca, light, square, late}), with_levels({light})};
    const std::map<std::string, double> expected{
        {"PCA", 1.0 / 6}, {"radial curvature", 1.0 / 6}, {"L.N", 1.0 / 6 + 0.5}};
    const auto found = selected_features(styles, FeatureUse::level);
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [type, share] : expected) EXPECT_NEAR(found.at(type), share, 1e-12) << type;
}

TEST(SelectedFeatures, AreNoneWhereNothingIsSelected) {
    const HatchingStyle style = with_levels({});
    EXPECT_TRUE(selected_features(std::span(&style, 1), FeatureUse::level).empty());
    EXPECT_TRUE(selected_features(std::span(&style, 1), FeatureUse::thickness).empty());
    EXPECT_TRUE(selected_features(std::span(&style, 1), FeatureUse::orientation).empty());
    EXPECT_TRUE(selected_features({}, FeatureUse::segment).empty());
}

// Every feature has a type of the thesis.
TEST(SelectedFeatures, AllHaveATypeOfTheirOwn) {
    for (const std::string& name : pixel_feature_names()) {
        const HatchingStyle style = with_levels({expanded_feature(name)});
        const auto found = selected_features(std::span(&style, 1), FeatureUse::level);
        EXPECT_FALSE(found.contains("other")) << name;
    }
    for (const std::string& name : orientation_feature_names()) {
        HatchingStyle style;
        style.rules.resize(1);
        style.rules[0].function[0].terms = {{orientation_feature(name), 1.0f}};
        style.share = {1};
        EXPECT_FALSE(selected_features(std::span(&style, 1), FeatureUse::orientation).contains("other")) << name;
    }
}

}  // namespace
}  // namespace exemplar
