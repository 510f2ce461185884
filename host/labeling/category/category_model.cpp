#include "host/labeling/category/category_model.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "host/core/errors.h"
#include "host/learn/softmax.h"

namespace exemplar {

std::vector<double> CategoryScores::of(std::span<const float> descriptor) const {
    const std::size_t count = mean.size();
    std::vector<double> squashed(count);
    for (std::size_t k = 0; k < count; ++k)
        squashed[k] = std::tanh((static_cast<double>(descriptor[k]) - static_cast<double>(mean[k])) *
                                static_cast<double>(inverse_deviation[k]));
    std::vector<double> scores(offset.begin(), offset.end());
    for (std::size_t c = 0; c < scores.size(); ++c)
        for (std::size_t k = 0; k < count; ++k) scores[c] += static_cast<double>(weights[c * count + k]) * squashed[k];
    return scores;
}

double category_evidence(std::span<const double> scores) {
    std::vector<double> sorted(scores.begin(), scores.end());
    std::ranges::partial_sort(sorted, sorted.begin() + 2, std::greater<>());
    return 2 * sorted[0] - sorted[1];
}

CategoryPrediction recognize(const CategoryModel& model, const ShapeDescriptor& shape) {
    if (shape.features != model.features || shape.values.size() != model.scores.mean.size())
        throw UsageError(
            "a shape's category cannot be recognized by other features than those learned from; compute them with the "
            "options of the model");
    const std::vector<double> scores = model.scores.of(shape.values);
    CategoryPrediction prediction;
    const auto best = std::ranges::max_element(scores);
    std::vector<double> probability = scores;
    // The largest is subtracted before the product, which could overflow.
    for (double& p : probability) p = model.sharpness * (p - *best);
    softmax(std::span(probability));
    prediction.probability.assign(probability.begin(), probability.end());
    prediction.confidence = static_cast<float>(model.confidence.probability(category_evidence(scores)));
    if (static_cast<double>(prediction.confidence) >= model.min_confidence)
        prediction.category = static_cast<std::int32_t>(best - scores.begin());
    return prediction;
}

CategoryPrediction recognize(const CategoryModel& model, const MeshFeatures& features) {
    return recognize(model, compute_shape_descriptor(features));
}

}  // namespace exemplar
