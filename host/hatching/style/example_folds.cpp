#include "host/hatching/style/example_folds.h"

#include <algorithm>
#include <array>

#include "host/core/random.h"
#include "host/hatching/features/powers.h"

namespace exemplar {
namespace {

constexpr std::size_t k_folds = 4;
// The side of a block is that of a large held-out rectangle: about a sixth of the object's extent.
constexpr std::size_t k_blocks_across = 6;

/// The least and the largest x and y of rows [first, end), of which there is at least one.
std::array<std::array<std::size_t, 2>, 2> extent(const HatchingExamples& views, std::uint32_t first,
                                                 std::uint32_t end) {
    std::array<std::size_t, 2> low{65535, 65535}, high{};
    for (std::uint32_t row = first; row < end; ++row) {
        const std::array<std::uint16_t, 2> place = views.place_of(row);
        for (std::size_t k = 0; k < 2; ++k) {
            low[k] = std::min<std::size_t>(low[k], place[k]);
            high[k] = std::max<std::size_t>(high[k], place[k]);
        }
    }
    return {low, high};
}

}  // namespace

ExampleFolds::ExampleFolds(const HatchingExamples& views, const ExampleFeatures& features, std::uint64_t seed)
    : features_(features), fold_(views.size()) {
    for (std::size_t view = 0; view < views.views().size(); ++view) {
        const std::uint32_t first = views.first_row(view);
        const auto end = first + static_cast<std::uint32_t>(views.views()[view].pixels.size());
        if (first == end) continue;
        const auto [low, high] = extent(views, first, end);
        const std::size_t side = std::max(high[0] - low[0], high[1] - low[1]) / k_blocks_across + 1;
        std::vector<std::uint8_t> of_block(k_blocks_across * k_blocks_across);
        for (std::size_t b = 0; b < of_block.size(); ++b) of_block[b] = static_cast<std::uint8_t>(b % k_folds);
        Random(seed).fork(view).shuffle(of_block);
        for (std::uint32_t row = first; row < end; ++row) {
            const std::array<std::uint16_t, 2> place = views.place_of(row);
            fold_[row] = of_block[(place[1] - low[1]) / side * k_blocks_across + (place[0] - low[0]) / side];
        }
    }
}

std::vector<float> ExampleFolds::unseen_probabilities(const ClassifierTraining& training,
                                                      std::span<const std::uint32_t> rows, const CalibratedStumps& like,
                                                      const SegmentContext& context,
                                                      const std::function<void()>& progress,
                                                      std::size_t first_feature) const {
    std::vector<std::uint8_t> fold;
    fold.reserve(rows.size());
    for (const std::uint32_t row : rows) fold.push_back(fold_[row]);
    std::vector<CalibratedStumps> learned = learn_without_folds(training, like, fold, k_folds, progress);
    for (CalibratedStumps& classifier : learned) {
        for (Stump& stump : classifier.stumps.stumps)
            stump.feature += static_cast<std::uint32_t>(k_powers * first_feature);
    }
    const std::vector<std::vector<float>> all = features_.probabilities(learned, context);
    std::vector<float> unseen(fold_.size() * training.classes);
    for (std::size_t row = 0; row < fold_.size(); ++row) {
        for (std::size_t c = 0; c < training.classes; ++c)
            unseen[row * training.classes + c] = all[fold_[row]][row * training.classes + c];
    }
    return unseen;
}

}  // namespace exemplar
