#include "host/labeling/evaluation/paired_difference.h"

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr std::size_t k_resamples = 2000;
constexpr double k_tail = 0.025;  ///< on either side of the interval
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

struct Sum {
    double total = 0, count = 0;
};

/// Per category the sum of each mesh's differences.
using Categories = std::vector<std::vector<Sum>>;

Categories group(std::span<const PairedDifference> differences) {
    std::map<std::string, std::map<std::string, Sum>> sums;
    for (const PairedDifference& difference : differences) {
        Sum& sum = sums[difference.category][difference.mesh];
        sum.total += difference.value, sum.count += 1;
    }
    Categories categories;
    categories.reserve(sums.size());
    for (const auto& [name, meshes] : sums) {
        categories.emplace_back();
        for (const auto& [mesh, sum] : meshes) categories.back().push_back(sum);
    }
    return categories;
}

/// Returns the mean over the categories, with the mesh `drawn(i, meshes)` in place of the i-th of a category.
template <typename Draw>
double mean_of(const Categories& categories, const Draw& drawn) {
    double mean = 0;
    for (const std::vector<Sum>& meshes : categories) {
        Sum all;
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            const Sum& one = meshes[drawn(i, meshes.size())];
            all.total += one.total, all.count += one.count;
        }
        mean += all.total / all.count / static_cast<double>(categories.size());
    }
    return mean;
}

}  // namespace

double mean_over_categories(std::span<const PairedDifference> values) {
    if (values.empty()) return k_nan;
    return mean_of(group(values), [](std::size_t i, std::size_t) { return i; });
}

DifferenceEstimate estimate_difference(std::span<const PairedDifference> differences, std::uint64_t seed) {
    if (differences.empty()) return {k_nan, k_nan, k_nan};
    const Categories categories = group(differences);
    Random random(seed);
    std::vector<double> means(k_resamples);
    for (double& mean : means)
        mean = mean_of(categories, [&](std::size_t, std::size_t count) { return random.index(count); });
    std::ranges::sort(means);
    const auto tail = static_cast<std::size_t>(k_tail * static_cast<double>(k_resamples));
    return {mean_over_categories(differences), means[tail], means[k_resamples - 1 - tail]};
}

}  // namespace exemplar
