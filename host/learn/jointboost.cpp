#include "host/learn/jointboost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/random.h"
#include "host/learn/boosting_rows.h"
#include "host/learn/boosting_weights.h"
#include "host/learn/hold_out.h"
#include "host/learn/stump_search.h"
#include "host/learn/subset_search.h"

namespace exemplar {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t k_chunk_rows = 8192;
constexpr std::size_t k_sampled_chunk_rows = 512;  // small where chunks are what is drawn
constexpr std::uint64_t k_order_task = 0, k_round_task = 1;

void check_options(const TrainingSet& training, std::size_t class_count, const BoostOptions& options) {
    if (class_count < 2 || class_count > k_max_classes) {
        throw UsageError("boosting was asked for " + std::to_string(class_count) + " classes; it takes 2 to " +
                         std::to_string(k_max_classes));
    }
    if (training.features.cols() == 0) throw UsageError("there are no features to learn from");
    if (options.exhaustive_classes > k_most_exhaustive) {
        throw UsageError("an exhaustive search over subsets of " + std::to_string(options.exhaustive_classes) +
                         " classes takes too long; at most " + std::to_string(k_most_exhaustive) + " are possible");
    }
    for (const double fraction : {options.shrinkage, options.feature_fraction, options.row_fraction}) {
        if (!(fraction > 0.0 && fraction <= 1.0)) {
            throw UsageError("the shrinkage or a fraction of features or rows is " + std::to_string(fraction) +
                             "; it must be above 0 and at most 1");
        }
    }
}

/// Collects the rows that weigh anything. Lanes are the classes from `first_class` on.
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
                        Random(options.seed).fork(k_order_task).next(),
                        options.row_fraction < 1.0 ? k_sampled_chunk_rows : k_chunk_rows,
                        [&](std::uint32_t entry, std::size_t l) { return weight_of(rows[entry], l + first_class); });
}

/// `share` of `count` indices (at least one), drawn at random, in rising order.
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

/// Draws chunks class by class, so that none is lost, and scales them up to stand for those left out.
std::vector<RowChunk> draw_chunks(const std::vector<RowChunk>& chunks, double share, Random& random) {
    std::vector<RowChunk> drawn;
    for (std::size_t begin = 0, end = 0; begin < chunks.size(); begin = end) {
        while (end < chunks.size() && chunks[end].lane == chunks[begin].lane) ++end;
        const std::vector<std::uint32_t> picks = draw(end - begin, share, random);
        double all = chunks[end - 1].end - chunks[begin].begin, kept = 0.0;
        for (const std::uint32_t pick : picks) kept += chunks[begin + pick].end - chunks[begin + pick].begin;
        for (const std::uint32_t pick : picks) {
            drawn.push_back(chunks[begin + pick]);
            drawn.back().scale = static_cast<float>(all / kept);
        }
    }
    return drawn;
}

/// The lanes that have rows of their own: only they may share a split.
SubsetSearch subsets_of(const BoostingRows& rows, std::size_t exhaustive_classes) {
    SubsetSearch subsets;
    for (const RowChunk& chunk : rows.chunks) {
        if (chunk.lane == k_no_lane) continue;
        const auto lane = static_cast<std::uint32_t>(chunk.lane);
        if (subsets.candidates.empty() || subsets.candidates.back() != lane) subsets.candidates.push_back(lane);
    }
    subsets.exhaustive = subsets.candidates.size() <= std::max<std::size_t>(exhaustive_classes, 1);
    return subsets;
}

/// One training run: the rows and their weights, and one stump per call of add_stump.
class Booster {
  public:
    Booster(const TrainingSet& training, std::size_t class_count, std::size_t first_class, const BoostOptions& options)
        : features_(training.features),
          options_(options),
          sampled_(options.feature_fraction < 1.0 || options.row_fraction < 1.0),
          first_class_(first_class),
          rows_(prepare_rows(training, class_count, first_class, options)),
          weights_(rows_),
          search_(rows_, features_, subsets_of(rows_, options.exhaustive_classes), !sampled_) {}

    /// Adds the best stump and returns the training loss after it.
    double add_stump(std::size_t round, BoostedStumps& classifier) {
        const SplitCandidate split = find_split(round);
        const StumpResponse response = fit_response(rows_, split).scaled(static_cast<float>(options_.shrinkage));
        Stump stump{split.feature, 0.0f, response.above, response.below, split.lanes << first_class_};
        if (split.lanes != 0) stump.threshold = features_.thresholds[split.feature][split.threshold];
        classifier.stumps.push_back(stump);
        classifier.elsewhere.insert(classifier.elsewhere.end(), first_class_, 0.0f);
        classifier.elsewhere.insert(classifier.elsewhere.end(), response.elsewhere.begin(), response.elsewhere.end());
        const double loss = weights_.apply(rows_, split, response);
        search_.weights_changed(split, weights_.factors());
        return loss;
    }

  private:
    SplitCandidate find_split(std::size_t round) {
        if (!sampled_) return search_.best();
        Random random = Random(options_.seed).fork(k_round_task).fork(round);
        std::vector<std::uint32_t> list;
        for (const std::uint32_t pick : draw(search_.features().size(), options_.feature_fraction, random)) {
            list.push_back(search_.features()[pick]);
        }
        return search_.best(draw_chunks(rows_.chunks, options_.row_fraction, random), list);
    }

    const QuantizedFeatures& features_;
    BoostOptions options_;
    bool sampled_;
    std::size_t first_class_;
    BoostingRows rows_;
    WeightUpdate weights_;
    StumpSearch search_;
};

BoostResult train(const TrainingSet& training, std::size_t class_count, bool gentle, const ValidationSet* validation,
                  const BoostOptions& options, const BoostCallback& callback) {
    check_options(training, class_count, options);
    Booster booster(training, class_count, gentle ? 1 : 0, options);
    const std::unique_ptr<HoldOut> held_out =
        validation ? std::make_unique<HoldOut>(*validation, class_count, gentle) : nullptr;
    BoostResult result;
    result.classifier.class_count = static_cast<std::uint32_t>(class_count);
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t round = 0; round < options.rounds; ++round) {
        check_interrupt();
        BoostRound measured{booster.add_stump(round, result.classifier), k_nan, k_nan};
        if (held_out) {
            held_out->add(result.classifier.stumps.back(), std::span(result.classifier.elsewhere).last(class_count),
                          measured);
        }
        result.curve.push_back(measured);
        if (callback) callback(measured, result.classifier);
        const double watched =
            options.monitor == BoostMonitor::loss ? measured.validation_loss : measured.validation_error;
        if (!held_out || watched < best) {
            best = watched;
            result.best_rounds = round + 1;
        }
        if (options.patience != 0 && round + 1 >= result.best_rounds + options.patience) break;
    }
    if (held_out && options.keep_best) result.classifier = truncate(result.classifier, result.best_rounds);
    return result;
}

}  // namespace

BoostResult train_jointboost(const TrainingSet& training, std::size_t class_count, const ValidationSet* validation,
                             const BoostOptions& options, const BoostCallback& callback) {
    return train(training, class_count, false, validation, options, callback);
}

BoostResult train_gentleboost(const TrainingSet& training, const ValidationSet* validation, const BoostOptions& options,
                              const BoostCallback& callback) {
    return train(training, 2, true, validation, options, callback);
}

std::vector<BoostRound> validation_curve(const BoostedStumps& classifier, const ValidationSet& validation,
                                         bool gentle) {
    HoldOut held_out(validation, classifier.class_count, gentle);
    const std::size_t classes = classifier.class_count;
    std::vector<BoostRound> curve;
    for (std::size_t m = 0; m < classifier.stumps.size(); ++m) {
        curve.push_back({k_nan, k_nan, k_nan});
        held_out.add(classifier.stumps[m], std::span(classifier.elsewhere).subspan(m * classes, classes), curve.back());
    }
    return curve;
}

BoostedStumps truncate(const BoostedStumps& classifier, std::size_t rounds) {
    BoostedStumps out = classifier;
    out.stumps.resize(std::min(rounds, out.stumps.size()));
    out.elsewhere.resize(out.stumps.size() * out.class_count);
    return out;
}

}  // namespace exemplar
