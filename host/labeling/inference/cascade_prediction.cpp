#include "host/labeling/inference/cascade_prediction.h"

#include <algorithm>
#include <numeric>

namespace exemplar {

void copy_class_probabilities(std::span<const std::uint32_t> taken, std::size_t classes, std::span<const float> source,
                              std::span<float> target) {
    if (taken.empty()) return;
    for (std::size_t begin = 0; begin < target.size(); begin += classes) {
        const std::span<const float> from = source.subspan(begin, classes);
        const std::span<float> to = target.subspan(begin, classes);
        float rest = 1;
        for (const std::uint32_t c : taken) rest -= from[c], to[c] = 0;
        const float others = std::accumulate(to.begin(), to.end(), 0.0F);
        const auto count = static_cast<float>(classes - taken.size());
        for (float& p : to) p = (others > k_no_probability ? p / others : 1 / count) * std::max(rest, 0.0F);
        for (const std::uint32_t c : taken) to[c] = from[c];
    }
}

void CascadePrediction::add_stage(std::span<float> probabilities) {
    if (averaged_.empty()) return;
    stages_ += 1;
    mean_.resize(probabilities.size(), 0.0F);
    for (std::size_t i = 0; i < mean_.size(); ++i) mean_[i] += (probabilities[i] - mean_[i]) / stages_;
    copy_class_probabilities(averaged_, classes_, mean_, probabilities);
}

}  // namespace exemplar
