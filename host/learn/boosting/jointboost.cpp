#include "host/learn/boosting/jointboost.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/random.h"
#include "host/learn/boosting/boosting_rows.h"
#include "host/learn/boosting/boosting_weights.h"
#include "host/learn/boosting/stump_search.h"
#include "host/learn/boosting/subset_search.h"
#include "host/learn/boosting/training_pairs.h"

namespace exemplar {
namespace {

constexpr std::size_t k_row_chunk = 8192;
constexpr std::uint64_t k_order_task = 0, k_round_task = 1;

void check_boost_options(const TrainingSet& training, std::size_t class_count, const BoostOptions& options) {
    if (class_count < 2 || class_count > k_max_classes) {
        throw UsageError("boosting was asked for " + std::to_string(class_count) + " classes; it takes 2 to " +
                         std::to_string(k_max_classes));
    }
    if (training.features.cols() == 0) throw UsageError("there are no features to learn from");
    if (options.exhaustive_classes > k_max_exhaustive_classes) {
        throw UsageError("an exhaustive search over subsets of " + std::to_string(options.exhaustive_classes) +
                         " classes takes too long; at most " + std::to_string(k_max_exhaustive_classes) +
                         " are possible");
    }
    for (const double fraction : {options.shrinkage, options.feature_fraction}) {
        if (!(fraction > 0.0 && fraction <= 1.0)) {
            throw UsageError("the shrinkage or the fraction of features is " + std::to_string(fraction) +
                             "; it must be above 0 and at most 1");
        }
    }
}

/// Collects the rows with a weight above zero. Lanes are the classes from `first_class` on.
BoostingRows prepare_rows(const TrainingSet& training, std::size_t class_count, std::size_t first_class,
                          const BoostOptions& options) {
    const std::size_t row_count = training.features.rows;
    std::vector<std::uint32_t> rows = used_rows(training.rows, row_count);
    check_pairs(rows, row_count, training.labels, training.weights, class_count);
    const bool per_class = training.weights.size() != row_count;
    const auto weight_of = [&](std::size_t row, std::size_t c) {
        return training.weights[per_class ? row * class_count + c : row];
    };
    std::erase_if(rows, [&](std::uint32_t row) {
        for (std::size_t c = first_class; c < class_count; ++c) {
            if (weight_of(row, c) > 0.0f) return false;
        }
        return true;
    });
    if (rows.empty()) throw DataError("all weights are zero; there is nothing to learn from");
    std::vector<std::int32_t> lane;
    lane.reserve(rows.size());
    for (const std::uint32_t row : rows) {
        lane.push_back(std::max(training.labels[row] - static_cast<std::int32_t>(first_class), k_no_lane));
    }
    return collect_rows(training.features, rows, lane, class_count - first_class,
                        Random(options.seed).fork(k_order_task).next(), k_row_chunk,
                        [&](std::uint32_t entry, std::size_t l) { return weight_of(rows[entry], l + first_class); });
}

/// Returns a `share` of `count` indices (at least one), drawn at random, in rising order.
std::vector<std::uint32_t> draw(std::size_t count, double share, Random& random) {
    std::vector<std::uint32_t> indices(count);
    std::iota(indices.begin(), indices.end(), 0u);
    const auto kept = static_cast<std::size_t>(std::ceil(share * static_cast<double>(count)));
    if (kept >= count) return indices;
    random.shuffle(indices);
    indices.resize(kept);
    std::sort(indices.begin(), indices.end());
    return indices;
}

/// Returns the lanes that have rows of their own: only they may share a split.
SubsetOptions subsets_of(const BoostingRows& rows, std::size_t exhaustive_classes) {
    SubsetOptions subsets;
    for (const RowChunk& chunk : rows.chunks) {
        if (chunk.lane == k_no_lane) continue;
        const auto lane = static_cast<std::uint32_t>(chunk.lane);
        if (subsets.candidates.empty() || subsets.candidates.back() != lane) subsets.candidates.push_back(lane);
    }
    subsets.exhaustive = subsets.candidates.size() <= std::max<std::size_t>(exhaustive_classes, 1);
    return subsets;
}

}  // namespace

/// The rows with their weights, and the search for the next stump.
class Booster::Run {
  public:
    Run(const TrainingSet& training, std::size_t class_count, std::size_t first_class, const BoostOptions& options)
        : features_(training.features),
          options_(options),
          first_class_(first_class),
          rows_(prepare_rows(training, class_count, first_class, options)),
          weights_(rows_),
          search_(rows_, features_, subsets_of(rows_, options.exhaustive_classes), !sampled()) {
        classifier_.class_count = static_cast<std::uint32_t>(class_count);
    }

    double add_stump() {
        const SplitCandidate split = find_split();
        const StumpResponse response = fit_response(rows_, split).scaled(static_cast<float>(options_.shrinkage));
        Stump stump{split.feature, 0.0f, response.above, response.below, split.lanes << first_class_};
        if (split.lanes != 0) stump.threshold = features_.thresholds[split.feature][split.threshold];
        classifier_.stumps.push_back(stump);
        classifier_.elsewhere.insert(classifier_.elsewhere.end(), first_class_, 0.0f);
        classifier_.elsewhere.insert(classifier_.elsewhere.end(), response.elsewhere.begin(), response.elsewhere.end());
        const double loss = weights_.apply(rows_, split, response);
        search_.weights_changed(split, weights_.factors());
        return loss;
    }
    const BoostedStumps& classifier() const { return classifier_; }

  private:
    bool sampled() const { return options_.feature_fraction < 1.0; }
    SplitCandidate find_split() {
        if (!sampled()) return search_.best();
        Random random = Random(options_.seed).fork(k_round_task).fork(classifier_.stumps.size());
        std::vector<std::uint32_t> list;
        for (const std::uint32_t pick : draw(search_.features().size(), options_.feature_fraction, random))
            list.push_back(search_.features()[pick]);
        return search_.best(list);
    }

    const QuantizedFeatures& features_;
    BoostOptions options_;
    std::size_t first_class_;
    BoostingRows rows_;
    WeightUpdate weights_;
    StumpSearch search_;
    BoostedStumps classifier_;
};

namespace {

BoostResult train(Booster booster, std::size_t rounds) {
    BoostResult result;
    for (std::size_t round = 0; round < rounds; ++round) {
        check_interrupt();
        result.loss.push_back(booster.add_stump());
    }
    result.classifier = booster.classifier();
    return result;
}

}  // namespace

Booster::Booster(std::unique_ptr<Run> run) : run_(std::move(run)) {}
Booster::Booster(const TrainingSet& training, std::size_t class_count, const BoostOptions& options) {
    check_boost_options(training, class_count, options);
    run_ = std::make_unique<Run>(training, class_count, 0, options);
}
Booster::Booster(Booster&&) noexcept = default;
Booster& Booster::operator=(Booster&&) noexcept = default;
Booster::~Booster() = default;

Booster Booster::gentle(const TrainingSet& training, const BoostOptions& options) {
    check_boost_options(training, 2, options);
    return Booster(std::make_unique<Run>(training, 2, 1, options));
}

double Booster::add_stump() {
    return run_->add_stump();
}

const BoostedStumps& Booster::classifier() const {
    return run_->classifier();
}

BoostResult train_jointboost(const TrainingSet& training, std::size_t class_count, const BoostOptions& options) {
    return train(Booster(training, class_count, options), options.rounds);
}

BoostResult train_gentleboost(const TrainingSet& training, const BoostOptions& options) {
    return train(Booster::gentle(training, options), options.rounds);
}

BoostedStumps truncate(const BoostedStumps& classifier, std::size_t rounds) {
    BoostedStumps out = classifier;
    out.stumps.resize(std::min(rounds, out.stumps.size()));
    out.elsewhere.resize(out.stumps.size() * out.class_count);
    return out;
}

}  // namespace exemplar
