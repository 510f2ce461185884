#include "host/hatching/features/expanded_features.h"

#include <algorithm>
#include <map>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

void add_power(const FeatureMatrix& base, std::size_t column, std::size_t power, FeatureMatrix& out) {
    const std::span<float> values = out.add(name_of_power(base.names[column], power));
    const std::span<const float> from = base.column(column);
    parallel_for(
        values.size(), [&](std::size_t i) { values[i] = power_of(from[i], power); }, 16384);
}

}  // namespace

StumpFeatures stump_features(const FeatureMatrix& base) {
    StumpFeatures out;
    out.matrix.rows = base.rows;
    for (std::size_t c = 0; c < base.cols(); ++c) {
        const std::span<const float> values = base.column(c);
        const bool negative = std::ranges::any_of(values, [](float x) { return x < 0; });
        const bool positive = std::ranges::any_of(values, [](float x) { return x > 0; });
        for (const std::size_t power : {0U, 1U, 2U}) {
            if (power > 0 && !(negative && positive)) continue;
            add_power(base, c, power, out.matrix);
            out.expanded.push_back(static_cast<std::uint32_t>(c * k_powers + power));
        }
    }
    return out;
}

std::vector<std::uint32_t> used_features(const BoostedStumps& classifier) {
    std::vector<std::uint32_t> used;
    for (const Stump& stump : classifier.stumps) used.push_back(stump.feature / k_powers);
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    return used;
}

CompactStumps compact_stumps(const BoostedStumps& classifier, std::span<const std::uint32_t> which) {
    CompactStumps out{classifier, {}};
    std::map<std::uint32_t, std::uint32_t> place;  // of an expanded feature among the columns
    for (Stump& stump : out.classifier.stumps) {
        const auto [known, is_new] = place.try_emplace(stump.feature, static_cast<std::uint32_t>(out.columns.size()));
        if (is_new) {
            const auto column = std::ranges::find(which, stump.feature / k_powers);
            if (column == which.end()) throw UsageError("a stump names a feature that was not measured");
            out.columns.push_back({static_cast<std::size_t>(column - which.begin()), stump.feature % k_powers});
        }
        stump.feature = known->second;
    }
    return out;
}

void expand_columns(std::span<const ExpandedColumn> columns, const FeatureMatrix& base, std::size_t first,
                    std::size_t count, FeatureMatrix& out) {
    out.rows = count;
    out.names.resize(columns.size());
    out.values.resize(columns.size() * count);
    parallel_for(
        columns.size(),
        [&](std::size_t k) {
            const std::span<const float> from = base.column(columns[k].base).subspan(first, count);
            const std::span<float> to = out.column(k);
            if (columns[k].power == 0)
                std::ranges::copy(from, to.begin());
            else
                std::ranges::transform(from, to.begin(), [&](float x) { return power_of(x, columns[k].power); });
        },
        8);
}

}  // namespace exemplar
