#include "host/labeling/training/fold_boosting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/labeling/inference/cascade_prediction.h"
#include "host/learn/boosting/calibration.h"
#include "host/learn/boosting/jointboost.h"
#include "host/learn/boosting/quantize.h"

namespace exemplar {
namespace {

constexpr std::size_t k_evaluation_interval = 10;     // of rounds, in the search for their number
constexpr std::size_t k_linear_rows = 32768;          // maximum for a linear classifier, as neighboring faces are alike
constexpr std::size_t k_max_unvalidated_rounds = 50;  // maximum if nothing can be held out
/// Factor on the link's scale for items that the classifier was trained on, where it is overconfident.
constexpr float k_seen_scale = 0.5F;

/// The rows of all meshes that boosting uses, concatenated.
struct TrainingRows {
    FeatureMatrix features;
    std::vector<std::int32_t> label;
    std::vector<float> weight;
    std::vector<std::uint8_t> fold;
};

/// The items of a mesh that boosting uses, in rising order, and their weights.
struct ChosenRows {
    std::vector<std::uint32_t> row;
    std::vector<float> weight;
};

/// Draws `limit` rows, but so many of each label, if there are, that half of the limit is dealt to the labels evenly: a
/// label of few items would hardly be drawn.
std::vector<std::uint32_t> draw_rows(const BoostingItems& mesh, std::vector<std::uint32_t> rows, std::size_t limit,
                                     std::size_t classes, Random random) {
    random.shuffle(rows);
    std::vector<std::size_t> left(classes, limit / (2 * classes));
    std::vector<std::uint32_t> drawn, others;
    for (const std::uint32_t row : rows) {
        std::size_t& of_label = left[static_cast<std::size_t>(mesh.label[row])];
        (of_label > 0 ? drawn : others).push_back(row);
        of_label -= of_label > 0 ? 1 : 0;
    }
    drawn.insert(drawn.end(), others.begin(), others.begin() + static_cast<std::ptrdiff_t>(limit - drawn.size()));
    std::sort(drawn.begin(), drawn.end());
    return drawn;
}

/// Returns the labeled items of a mesh, or a random part of them, whose labels keep the weights that all items give
/// them.
ChosenRows choose_rows_of(const BoostingItems& mesh, std::size_t limit, std::size_t classes, const Random& random) {
    ChosenRows chosen;
    std::vector<double> all(classes, 0), kept(classes, 0);
    for (std::uint32_t i = 0; i < mesh.label.size(); ++i)
        if (mesh.label[i] >= 0) {
            chosen.row.push_back(i);
            all[static_cast<std::size_t>(mesh.label[i])] += static_cast<double>(mesh.weight[i]);
        }
    const bool draws = limit > 0 && chosen.row.size() > limit;
    if (draws) chosen.row = draw_rows(mesh, std::move(chosen.row), limit, classes, random);
    for (const std::uint32_t row : chosen.row)
        kept[static_cast<std::size_t>(mesh.label[row])] += static_cast<double>(mesh.weight[row]);
    chosen.weight.reserve(chosen.row.size());
    for (const std::uint32_t row : chosen.row) {
        const auto label = static_cast<std::size_t>(mesh.label[row]);
        const double scale = draws && kept[label] > 0 ? all[label] / kept[label] : 1;
        chosen.weight.push_back(static_cast<float>(scale * static_cast<double>(mesh.weight[row])));
    }
    return chosen;
}

TrainingRows collect_training_rows(std::span<const BoostingItems> meshes, const FoldBoostingOptions& options) {
    std::vector<ChosenRows> rows;
    std::vector<std::size_t> offset{0};
    const Random random(options.seed);
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        rows.push_back(choose_rows_of(meshes[m], options.rows_per_mesh, options.classes, random.fork(m)));
        offset.push_back(offset.back() + rows.back().row.size());
    }
    TrainingRows pool;
    pool.features.rows = offset.back();
    pool.features.values.resize(options.features * offset.back());
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const FeatureMatrix& features = meshes[m].features();
        const auto names = std::span(features.names).first(options.features);
        pool.features.names.assign(names.begin(), names.end());
        parallel_for(options.features, [&](std::size_t f) {
            float* out = pool.features.values.data() + f * offset.back() + offset[m];
            for (const std::uint32_t row : rows[m].row) *out++ = features.column(f)[row];
        });
        for (const std::uint32_t row : rows[m].row) {
            pool.label.push_back(meshes[m].label[row]);
            pool.fold.push_back(meshes[m].fold[row]);
        }
        pool.weight.insert(pool.weight.end(), rows[m].weight.begin(), rows[m].weight.end());
    }
    return pool;
}

Booster start(const TrainingRows& pool, const QuantizedFeatures& quantized, std::span<const std::uint32_t> rows,
              const FoldBoostingOptions& options) {
    BoostOptions boost;
    boost.seed = options.seed;
    boost.feature_fraction = options.feature_fraction, boost.shrinkage = options.shrinkage;
    const TrainingSet training{quantized, pool.label, pool.weight, rows};
    return options.binary ? Booster::gentle(training, boost) : Booster(training, options.classes, boost);
}

/// One classifier per fold, trained on the rows of the others, and one trained on all rows. None for a fold where one
/// side of the split has no rows.
class FoldBoosters {
  public:
    FoldBoosters(const TrainingRows& pool, const QuantizedFeatures& quantized, const FoldBoostingOptions& options)
        : booster_(options.folds + 1) {
        for (std::size_t fold = 0; fold < options.folds; ++fold) {
            std::vector<std::uint32_t> inside;
            for (std::uint32_t row = 0; row < pool.fold.size(); ++row)
                if (pool.fold[row] != fold) inside.push_back(row);
            if (inside.empty() || inside.size() == pool.fold.size()) continue;
            booster_[fold] = start(pool, quantized, inside, options);
        }
        booster_.back() = start(pool, quantized, {}, options);
    }
    /// Grows all classifiers to `rounds` rounds, side by side: the loops within a round are too short for many cores.
    void grow_to(std::size_t rounds, const std::function<void()>& round_done) {
        parallel_for(booster_.size(), [&](std::size_t i) {
            while (booster_[i] && booster_[i]->classifier().stumps.size() < rounds) {
                check_interrupt();
                booster_[i]->add_stump();
                round_done();
            }
        });
    }
    /// Returns the classifier trained without a fold; null if there is none.
    const BoostedStumps* without(std::size_t fold) const {
        return booster_[fold] ? &booster_[fold]->classifier() : nullptr;
    }
    /// Returns the first rounds of the classifier trained on all rows.
    BoostedStumps everywhere(std::size_t rounds) const { return truncate(booster_.back()->classifier(), rounds); }
    /// Returns the first rounds of the classifiers of all folds; one without classes where there is none.
    std::vector<BoostedStumps> of_folds(std::size_t rounds) const {
        std::vector<BoostedStumps> stumps;
        for (std::size_t fold = 0; fold + 1 < booster_.size(); ++fold)
            stumps.push_back(booster_[fold] ? truncate(booster_[fold]->classifier(), rounds) : BoostedStumps());
        return stumps;
    }

  private:
    std::vector<std::optional<Booster>> booster_;
};

/// Counts the rows of each label per fold. If a label occurs in one fold only, the classifier of the others cannot
/// know it.
class FoldLabels {
  public:
    FoldLabels(const TrainingRows& pool, const FoldBoostingOptions& options)
        : classes_(options.classes), folds_(options.folds), rows_(folds_ * classes_, 0), total_(classes_, 0) {
        for (std::size_t i = 0; i < pool.label.size(); ++i) {
            const auto label = static_cast<std::size_t>(pool.label[i]);
            ++rows_[pool.fold[i] * classes_ + label], ++total_[label];
        }
    }
    /// Returns whether this label has rows outside of the fold.
    bool known_without(std::size_t fold, std::size_t label) const {
        return total_[label] > rows_[fold * classes_ + label];
    }
    /// Returns the labels that have all their rows in the fold.
    std::vector<std::uint32_t> of_fold_alone(std::size_t fold) const {
        std::vector<std::uint32_t> alone;
        for (std::uint32_t label = 0; label < classes_; ++label)
            if (total_[label] > 0 && !known_without(fold, label)) alone.push_back(label);
        return alone;
    }

  private:
    std::size_t classes_, folds_;
    std::vector<std::size_t> rows_, total_;
};

/// H of every row from the classifier of the fold that held it out, grown round by round.
class HeldOutScores {
  public:
    HeldOutScores(const TrainingRows& pool, const FoldBoosters& boosters, const FoldBoostingOptions& options)
        : pool_(pool), boosters_(boosters), classes_(options.classes), scores_(pool.label.size() * classes_, 0.0F) {
        const FoldLabels labels(pool, options);
        for (std::size_t i = 0; i < pool.label.size(); ++i) {
            const bool known = labels.known_without(pool.fold[i], static_cast<std::size_t>(pool.label[i]));
            weight_.push_back(boosters.without(pool.fold[i]) && known ? pool.weight[i] : 0);
        }
    }

    /// Adds the rounds that the classifiers have grown since the last call.
    void add_rounds(std::size_t end) {
        parallel_for(pool_.label.size(), [&](std::size_t i) {
            const BoostedStumps* classifier = boosters_.without(pool_.fold[i]);
            for (std::size_t round = rounds_; classifier && round < end; ++round) add_round(*classifier, round, i);
        });
        rounds_ = end;
    }

    Calibration judge(std::span<const Link> links) const {
        return calibrate(scores_, pool_.label, weight_, classes_, links);
    }
    const std::vector<float>& scores() const { return scores_; }
    /// Weight of each row in the loss: 0 if its label occurs in its fold only.
    const std::vector<float>& weight() const { return weight_; }

  private:
    void add_round(const BoostedStumps& classifier, std::size_t round, std::size_t row) {
        const Stump& stump = classifier.stumps[round];
        const bool above = pool_.features.column(stump.feature)[row] > stump.threshold;
        for (std::size_t c = 0; c < classes_; ++c)
            scores_[row * classes_ + c] += (stump.classes >> c & 1) ? (above ? stump.above : stump.below)
                                                                    : classifier.elsewhere[round * classes_ + c];
    }

    const TrainingRows& pool_;
    const FoldBoosters& boosters_;
    std::size_t classes_, rounds_ = 0;
    std::vector<float> scores_, weight_;
};

/// The number of rounds after which the held-out rows are labeled best, with their calibration.
struct RoundChoice {
    std::size_t rounds = 0;
    Calibration calibration;
    std::vector<HeldOutPoint> curve;
    std::vector<float> scores, weight;  ///< H of the held-out rows there, and their weights in the loss
};

/// Returns the number of rounds after which held-out rows are labeled next. Labeling them costs as much as some rounds,
/// so it is done often only where the loss decides the number of rounds.
std::size_t next_evaluation(std::size_t rounds, const FoldBoostingOptions& options) {
    const std::size_t next = options.patience == 0 ? 2 * rounds
                             : rounds < 10         ? rounds + 1
                                                   : rounds + k_evaluation_interval;
    return std::min(std::max<std::size_t>(next, 1), options.rounds);
}

/// Grows the classifiers until the held-out loss has not fallen for `patience` rounds, or to the end.
RoundChoice choose_rounds(const TrainingRows& pool, FoldBoosters& boosters, const FoldBoostingOptions& options,
                          const std::function<void()>& round_done) {
    constexpr std::array<Link, 2> k_links{Link::softmax, Link::sigmoid};
    // GentleBoost's class 0 has no score of its own, so sigmoids do not apply.
    const std::span<const Link> usable = std::span(k_links).first(options.binary ? 1 : 2);
    HeldOutScores scores(pool, boosters, options);
    RoundChoice choice;
    for (std::size_t round = 0; round < options.rounds;) {
        round = next_evaluation(round, options);
        boosters.grow_to(round, round_done);
        scores.add_rounds(round);
        const Calibration now = scores.judge(usable);
        choice.curve.push_back({round, now.loss, now.error});
        if (options.patience == 0 || choice.rounds == 0 || now.loss < choice.calibration.loss)
            choice.rounds = round, choice.calibration = now;
        if (options.linear && choice.rounds == round) choice.scores = scores.scores();
        if (options.patience > 0 && round >= choice.rounds + options.patience) break;
    }
    if (std::isnan(choice.calibration.loss))  // nothing could be held out: use few rounds
        choice.rounds = std::min(options.rounds, k_max_unvalidated_rounds), choice.curve.clear();
    boosters.grow_to(choice.rounds, round_done);
    choice.weight = scores.weight();
    return choice;
}

/// Fits the linear classifier that is combined with the stumps, if that helps.
std::optional<FoldedLinear> fit_beside(const TrainingRows& pool, const RoundChoice& choice, const FoldLabels& labels,
                                       const FoldBoostingOptions& options) {
    if (std::isnan(choice.calibration.loss)) return std::nullopt;
    std::vector<float> stumps = choice.scores;
    scores_to_probabilities(stumps, options.classes, choice.calibration.link, choice.calibration.scale);
    const std::size_t step = std::max<std::size_t>(1, (pool.label.size() + k_linear_rows - 1) / k_linear_rows);
    std::vector<std::uint32_t> rows;
    for (std::size_t row = 0; row < pool.label.size(); row += step) rows.push_back(static_cast<std::uint32_t>(row));
    std::vector<bool> excluded_folds;
    for (std::size_t fold = 0; fold < options.folds; ++fold)
        excluded_folds.push_back(!labels.of_fold_alone(fold).empty());
    return fit_linear({pool.features, rows, pool.label, pool.weight, pool.fold, options.classes, options.folds}, stumps,
                      choice.weight, excluded_folds);
}

/// Returns the probabilities of every item of every mesh, from the classifier trained without its fold. Labels that
/// this classifier cannot know, because they occur in the fold only, get those of the final classifier at a reduced
/// scale: otherwise the next stage, for which this is the context, would learn that such a label never occurs nearby.
std::vector<std::vector<float>> score_out_of_fold(std::span<const BoostingItems> meshes,
                                                  const std::vector<BoostedStumps>& of_fold,
                                                  const CalibratedStumps& everywhere,
                                                  const std::optional<FoldedLinear>& linear,
                                                  std::span<const std::uint32_t> single_fold_labels,
                                                  const FoldLabels& labels, std::size_t classes, StumpScorer& scorer) {
    std::vector<std::vector<float>> result;
    for (const BoostingItems& mesh : meshes) {
        const std::size_t size = mesh.fold.size() * classes;
        const FeatureMatrix& features = mesh.features();
        std::vector<float> scores(size), from_fold(size), seen(size);
        for (std::size_t fold = 0; fold < of_fold.size(); ++fold) {
            const auto holds = [&](std::uint8_t f) { return f == fold; };
            if (std::none_of(mesh.fold.begin(), mesh.fold.end(), holds)) continue;
            const BoostedStumps& classifier = of_fold[fold].class_count ? of_fold[fold] : everywhere.stumps;
            scorer.probabilities(classifier, features, everywhere.link, everywhere.scale, from_fold);
            if (linear) pool(linear->without_fold[fold], features, single_fold_labels, from_fold);
            const std::vector<std::uint32_t> alone = labels.of_fold_alone(fold);
            if (!alone.empty())
                scorer.probabilities(everywhere.stumps, features, everywhere.link, k_seen_scale * everywhere.scale,
                                     seen);
            for (std::size_t i = 0; i < mesh.fold.size(); ++i) {
                if (mesh.fold[i] != fold) continue;
                const std::span<float> item = std::span(scores).subspan(i * classes, classes);
                for (std::size_t c = 0; c < classes; ++c) item[c] = from_fold[i * classes + c];
                copy_class_probabilities(alone, classes, std::span(seen).subspan(i * classes, classes), item);
            }
        }
        result.push_back(std::move(scores));
    }
    return result;
}

}  // namespace

FoldBoostingResult boost_with_folds(std::span<const BoostingItems> meshes, const FoldBoostingOptions& options,
                                    StumpScorer& scorer, const std::function<void()>& round_done) {
    const TrainingRows pool = collect_training_rows(meshes, options);
    if (pool.label.empty()) throw DataError("no face of the training meshes has a label");
    QuantizeOptions quantize_options;
    quantize_options.bins = options.bins;
    const QuantizedFeatures quantized = quantize(pool.features, pool.weight, quantize_options);
    RoundChoice choice;
    std::vector<BoostedStumps> of_fold, all;
    {
        FoldBoosters boosters(pool, quantized, options);  // each holds a copy of its rows
        choice = choose_rounds(pool, boosters, options, round_done);
        of_fold = boosters.of_folds(choice.rounds);
        all.push_back(boosters.everywhere(choice.rounds));
    }
    FoldBoostingResult result;
    const FoldLabels labels(pool, options);
    for (std::size_t fold = 0; fold < of_fold.size(); ++fold) {
        const std::vector<std::uint32_t> alone = labels.of_fold_alone(fold);
        result.single_fold_labels.insert(result.single_fold_labels.end(), alone.begin(), alone.end());
        if (of_fold[fold].class_count > 0 && alone.empty()) all.push_back(of_fold[fold]);
    }
    result.classifier.stumps = mean_classifier(all);
    result.rounds = choice.rounds;
    result.classifier.link = choice.calibration.link;
    result.classifier.scale = choice.calibration.scale;
    result.loss = result.stumps_loss = choice.calibration.loss, result.error = choice.calibration.error;
    result.curve = std::move(choice.curve);
    const auto linear = options.linear ? fit_beside(pool, choice, labels, options) : std::nullopt;
    if (linear) {
        result.linear = linear->mean;
        result.loss = linear->loss, result.error = linear->error, result.stumps_loss = linear->stumps_loss;
    }
    result.out_of_fold = score_out_of_fold(meshes, of_fold, result.classifier, linear, result.single_fold_labels,
                                           labels, options.classes, scorer);
    return result;
}

}  // namespace exemplar
