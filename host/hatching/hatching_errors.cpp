#include "host/hatching/hatching_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/core/errors.h"
#include "host/core/statistics.h"

namespace exemplar {

HatchingErrors compare_hatching(const HatchingFields& fields, const HatchingFields& truth,
                                std::span<const std::uint32_t> pixels) {
    if (fields.width != truth.width || fields.height != truth.height)
        throw UsageError("targets and truth have different sizes");
    HatchingErrors errors;
    errors.pixels = pixels.size();
    std::vector<float> angles;
    std::array<std::vector<float>, k_stroke_properties> ratios;
    std::array<std::size_t, 3> counts{};
    std::size_t right = 0;
    for (const std::uint32_t p : pixels) {
        right += fields.level[p] == truth.level[p] ? 1 : 0;
        ++counts[truth.level[p]];
        for (std::size_t layer = 0; layer < k_hatch_layers; ++layer) {
            const bool compared = layer == 0 ? truth.level[p] > 0 : truth.level[p] == 2 && fields.level[p] == 2;
            if (compared)
                angles.push_back(orientation_difference(fields.orientation[layer][p], truth.orientation[layer][p]));
        }
        if (truth.level[p] == 0) continue;
        for (std::size_t k = 0; k < k_stroke_properties; ++k) {
            const auto property = static_cast<StrokeProperty>(k);
            ratios[k].push_back(std::abs(property_of(fields, property)[p] / property_of(truth, property)[p] - 1));
        }
    }
    errors.orientation = static_cast<double>(upper_median(angles)) * 180 / std::numbers::pi;
    const double all = std::max<double>(static_cast<double>(pixels.size()), 1);
    errors.level_accuracy = static_cast<double>(right) / all;
    errors.majority_level = static_cast<double>(std::ranges::max(counts)) / all;
    for (std::size_t k = 0; k < k_stroke_properties; ++k)
        errors.property[k] = static_cast<double>(upper_median(ratios[k]));
    return errors;
}

}  // namespace exemplar
