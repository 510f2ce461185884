#include "host/hatching/style/cut_learning.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace exemplar {
namespace {

// From the weakest cut to the strongest: from one that drops single pixels to one that leaves large regions only, and
// from borders that cost little where P(e) is high to borders that cost the same everywhere.
constexpr std::array k_strengths{0.3f, 1.0f, 3.0f, 10.0f};
constexpr std::array k_offsets{-0.35f, -0.7f, -1.5f, -3.0f};

/// Parameters, and the share of wrong labels with them.
struct CutTrial {
    PixelCrfParameters parameters;
    double error;
};

double share_wrong(const CutTraining& training, std::span<const std::int32_t> labels) {
    double wrong = 0;
    for (std::size_t i = 0; i < training.rows.size(); ++i)
        wrong += labels[training.rows[i]] != training.labels[i] ? 1 : 0;
    return training.rows.empty() ? 0 : wrong / static_cast<double>(training.rows.size());
}

}  // namespace

ExampleCuts::ExampleCuts(const HatchingExamples& views, const ExampleFeatures& features,
                         std::span<const float> boundary)
    : features_(features) {
    cuts_.reserve(views.views().size());
    for (std::size_t view = 0; view < views.views().size(); ++view) {
        const auto& [pixels, drawing] = views.views()[view];
        cuts_.emplace_back(pixels.pixels(), drawing.width, features.of_view(view, boundary, 1));
    }
}

std::vector<std::int32_t> ExampleCuts::solve(std::span<const float> probabilities, std::size_t classes,
                                             const PixelCrfParameters& parameters) {
    std::vector<std::int32_t> labels;
    for (std::size_t view = 0; view < cuts_.size(); ++view) {
        const std::vector<std::int32_t> some =
            cuts_[view].solve(features_.of_view(view, probabilities, classes), classes, parameters);
        labels.insert(labels.end(), some.begin(), some.end());
    }
    return labels;
}

PixelCrfParameters ExampleCuts::learn(const CutTraining& training, const std::function<void()>& progress) {
    std::vector<CutTrial> trials;
    for (const float strength : k_strengths) {
        for (const float offset : k_offsets) {
            const std::vector<std::int32_t> labels =
                solve(training.probabilities, training.classes, {strength, offset});
            trials.push_back({{strength, offset}, share_wrong(training, labels)});
            progress();
        }
    }
    const double least = std::ranges::min(trials, {}, &CutTrial::error).error;
    const double chance =
        std::sqrt(least * (1 - least) / static_cast<double>(std::max<std::size_t>(1, training.rows.size())));
    return std::ranges::find_if(trials, [&](const CutTrial& t) { return t.error <= least + chance; })->parameters;
}

}  // namespace exemplar
