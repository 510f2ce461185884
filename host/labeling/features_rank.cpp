#include <algorithm>

#include "host/core/parallel.h"
#include "host/labeling/feature_families.h"
#include "host/labeling/percentile.h"

namespace exemplar {
namespace {

/// Logarithms keep the order of values, and ratios are functions of what is ranked anyway.
bool is_ranked(const std::string& name) {
    if (name.find('/') != std::string::npos) return false;
    return name.starts_with("geodesic.") || name.starts_with("diameter.") || name.starts_with("medial.") ||
           name.starts_with("pca.s");
}

/// The share of the surface with smaller values, linear between the bins of a histogram: where many values are nearly
/// equal their order is noise.
void rank_by_area(std::span<const float> values, std::span<const float> area_share, std::span<float> ranks) {
    constexpr std::size_t k_bins = 256;
    const auto range = std::ranges::minmax(values);
    const float low = range.min, high = range.max;
    const float per_bin = high > low ? static_cast<float>(k_bins) / (high - low) : 0.0F;
    const auto place = [&](float value) { return std::min((value - low) * per_bin, static_cast<float>(k_bins)); };
    std::array<double, k_bins + 1> below{};  // area below each bin's lower end
    for (std::size_t f = 0; f < values.size(); ++f) {
        const auto bin = std::min(static_cast<std::size_t>(place(values[f])), k_bins - 1);
        below[bin + 1] += static_cast<double>(area_share[f]);
    }
    for (std::size_t bin = 0; bin < k_bins; ++bin) below[bin + 1] += below[bin];
    const double total = below.back() > 0.0 ? below.back() : 1.0;
    for (std::size_t f = 0; f < values.size(); ++f) {
        const float at = place(values[f]);
        const auto bin = std::min(static_cast<std::size_t>(at), k_bins - 1);
        const double inside = static_cast<double>(at) - static_cast<double>(bin);
        ranks[f] = static_cast<float>((below[bin] + inside * (below[bin + 1] - below[bin])) / total);
    }
}

}  // namespace

FeatureMatrix rank_features(const PreparedMesh& prepared, const FeatureMatrix& unary) {
    FeatureMatrix matrix;
    matrix.rows = unary.rows;
    std::vector<std::size_t> source;
    for (std::size_t k = 0; k < unary.cols(); ++k) {
        if (!is_ranked(unary.names[k])) continue;
        matrix.add("rank." + unary.names[k]);
        source.push_back(k);
    }
    parallel_for(source.size(),
                 [&](std::size_t k) { rank_by_area(unary.column(source[k]), prepared.area_share, matrix.column(k)); });
    return matrix;
}

}  // namespace exemplar
