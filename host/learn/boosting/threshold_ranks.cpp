#include "host/learn/boosting/threshold_ranks.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace exemplar {
namespace {

constexpr std::size_t k_ranking_block =
    512;  // values ranked together: these and their ranks stay in the first-level cache
// Up to this many thresholds, comparing every value with each threshold (vectorized) is faster than searching.
constexpr std::size_t k_max_compared = 128;

template <typename Rank>
void rank_block(std::span<const float> values, std::span<const float> thresholds, Rank lowest, std::span<Rank> ranks) {
    if (thresholds.size() > k_max_compared) {
        for (std::size_t i = 0; i < values.size(); ++i)
            ranks[i] =
                static_cast<Rank>(lowest + (std::ranges::lower_bound(thresholds, values[i]) - thresholds.begin()));
        return;
    }
    std::ranges::fill(ranks, lowest);
    for (const float threshold : thresholds)
        for (std::size_t i = 0; i < values.size(); ++i)
            ranks[i] = static_cast<Rank>(ranks[i] + (values[i] > threshold ? 1 : 0));
}

// The output may be memory that is slow to read, so each rank is written once.
template <typename Rank>
void rank_all(std::span<const float> values, std::span<const float> thresholds, Rank lowest, std::span<Rank> ranks) {
    std::array<Rank, k_ranking_block> block;
    for (std::size_t begin = 0; begin < values.size(); begin += k_ranking_block) {
        const std::size_t count = std::min(k_ranking_block, values.size() - begin);
        rank_block(values.subspan(begin, count), thresholds, lowest, std::span(block).first(count));
        std::copy_n(block.begin(), count, ranks.begin() + static_cast<std::ptrdiff_t>(begin));
    }
}

std::vector<FeatureThresholds> sorted_thresholds(std::map<std::uint32_t, std::vector<float>>& of_feature) {
    std::vector<FeatureThresholds> result;
    for (auto& [feature, thresholds] : of_feature) {
        std::ranges::sort(thresholds);
        thresholds.erase(std::unique(thresholds.begin(), thresholds.end()), thresholds.end());
        result.push_back({feature, std::move(thresholds)});
    }
    return result;
}

}  // namespace

std::uint32_t FeatureThresholds::index_of(float threshold) const {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(thresholds, threshold) - thresholds.begin());
}

std::vector<FeatureThresholds> thresholds_of(std::span<const Stump> stumps) {
    std::map<std::uint32_t, std::vector<float>> of_feature;
    for (const Stump& stump : stumps) of_feature[stump.feature].push_back(stump.threshold);
    return sorted_thresholds(of_feature);
}

std::vector<FeatureThresholds> merged(std::span<const std::vector<FeatureThresholds>> lists) {
    std::map<std::uint32_t, std::vector<float>> of_feature;
    for (const std::vector<FeatureThresholds>& list : lists)
        for (const FeatureThresholds& column : list) {
            std::vector<float>& all = of_feature[column.feature];
            all.insert(all.end(), column.thresholds.begin(), column.thresholds.end());
        }
    return sorted_thresholds(of_feature);
}

void rank(std::span<const float> values, std::span<const float> thresholds, std::span<std::uint8_t> ranks,
          std::uint8_t lowest) {
    rank_all(values, thresholds, lowest, ranks);
}

void rank(std::span<const float> values, std::span<const float> thresholds, std::span<std::uint16_t> ranks,
          std::uint16_t lowest) {
    rank_all(values, thresholds, lowest, ranks);
}

}  // namespace exemplar
