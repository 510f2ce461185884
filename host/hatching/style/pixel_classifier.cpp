#include "host/hatching/style/pixel_classifier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/hatching/features/expanded_features.h"
#include "host/learn/boosting/calibration.h"
#include "host/learn/boosting/jointboost.h"

namespace exemplar {
namespace {

/// How many rounds without gain end boosting, and how many pass between evaluations of the held-out rows.
struct Patience {
    std::size_t rounds, between;
};
constexpr Patience k_patience{60, 5}, k_patience_for_details{800, 10};
// Pixels of a drawing are similar: full steps fit them in a few rounds and generalize worse.
constexpr double k_shrinkage = 0.3;
// Rows that are classified together. Memory for hundreds of columns of all pixels would take longer to get than the
// classification.
constexpr std::size_t k_rows_at_once = 16384;

/// Sums of the stumps for the held-out rows, updated as stumps are added.
class HeldOutScores {
  public:
    HeldOutScores(const FeatureMatrix& features, std::span<const std::uint32_t> rows, std::size_t classes)
        : features_(features), rows_(rows), classes_(classes), scores_(rows.size() * classes) {}

    void add(const BoostedStumps& classifier) {
        for (; seen_ < classifier.stumps.size(); ++seen_) {
            const Stump& stump = classifier.stumps[seen_];
            const std::span<const float> column = features_.column(stump.feature);
            for (std::size_t i = 0; i < rows_.size(); ++i) {
                const float h = column[rows_[i]] > stump.threshold ? stump.above : stump.below;
                for (std::size_t c = 0; c < classes_; ++c) {
                    const bool shares = (stump.classes >> c & 1U) != 0;
                    scores_[i * classes_ + c] += shares ? h : classifier.elsewhere[seen_ * classes_ + c];
                }
            }
        }
    }
    std::span<const float> scores() const { return scores_; }

  private:
    const FeatureMatrix& features_;
    std::span<const std::uint32_t> rows_;
    std::size_t classes_;
    std::size_t seen_ = 0;
    std::vector<float> scores_;
};

std::vector<std::uint32_t> rows_where(std::span<const std::uint8_t> held_out, std::uint8_t value) {
    std::vector<std::uint32_t> rows;
    for (std::uint32_t i = 0; i < held_out.size(); ++i) {
        if (held_out[i] == value) rows.push_back(i);
    }
    return rows;
}

template <typename T>
std::vector<T> chosen(std::span<const T> values, std::span<const std::uint32_t> rows) {
    std::vector<T> out;
    for (const std::uint32_t row : rows) out.push_back(values[row]);
    return out;
}

Booster booster_of(const ClassifierTraining& training, const TrainingSet& set) {
    const BoostOptions options{
        .shrinkage = k_shrinkage, .feature_fraction = training.detailed ? 0.2 : 1.0, .seed = training.seed};
    return training.gentle ? Booster::gentle(set, options) : Booster(set, training.classes, options);
}

/// Returns the classifier of so many rounds.
BoostedStumps boosted(const ClassifierTraining& training, const TrainingSet& set, std::size_t rounds,
                      const std::function<void()>& progress) {
    Booster booster = booster_of(training, set);
    for (std::size_t round = 0; round < rounds; ++round) {
        check_interrupt();
        booster.add_stump();
        progress();
    }
    return booster.classifier();
}

/// Numbers the features of stumps as the expanded set does (powers.h).
void number_expanded(BoostedStumps& classifier, std::span<const std::uint32_t> expanded) {
    for (Stump& stump : classifier.stumps) stump.feature = expanded[stump.feature];
}

/// Returns, per face, geodesic range and label, the mean probability of the pixels in that range; normalized per face.
std::vector<float> mean_probabilities_around_faces(const HatchingSurface& surface, const GBuffer& gbuffer,
                                                   const CoveredPixels& pixels, std::span<const float> probabilities,
                                                   std::size_t labels) {
    // Pixels are accumulated at the surface samples nearest to their faces.
    const std::size_t samples = surface.sample_face.size(), faces = surface.mesh.face_count();
    std::vector<float> seen(samples), sums(samples * labels);
    for (std::size_t i = 0; i < pixels.pixel.size(); ++i) {
        const std::uint32_t s = surface.face_sample[gbuffer.face[pixels.pixel[i]]];
        seen[s] += 1;
        for (std::size_t c = 0; c < labels; ++c) sums[s * labels + c] += probabilities[i * labels + c];
    }
    const std::size_t columns = k_context_ranges * labels;
    std::vector<float> at_face(faces * columns);
    parallel_ranges(faces, 256, [&](std::size_t begin, std::size_t end) {
        std::vector<float> count(k_context_ranges);
        for (std::size_t f = begin; f < end; ++f) {
            std::ranges::fill(count, 0.0f);
            float* out = at_face.data() + f * columns;
            for (std::size_t s = 0; s < samples; ++s) {
                const std::uint8_t range = surface.sample_bin[s * faces + f];
                if (!(seen[s] > 0) || range >= k_context_ranges) continue;
                count[range] += seen[s];
                for (std::size_t c = 0; c < labels; ++c) out[range * labels + c] += sums[s * labels + c];
            }
            float total = 0;
            for (std::size_t k = 0; k < columns; ++k) {
                out[k] = count[k / labels] > 0 ? out[k] / count[k / labels] : 0.0f;
                total += out[k];
            }
            for (std::size_t k = 0; k < columns && total > 0; ++k) out[k] /= total;
        }
    });
    return at_face;
}

/// A number of boosting rounds, and the loss and error of held-out rows after them.
struct JudgedRounds {
    std::size_t rounds = 0;
    Calibration held;
};

/// Returns how far above the lowest error of held-out rows another may be by chance: a standard error.
double chance_of(double least, std::size_t held_out) {
    return std::sqrt(least * (1 - least) / static_cast<double>(std::max<std::size_t>(1, held_out)));
}

/// All rounds on the rows that are not held out.
struct JudgedBoosting {
    std::vector<JudgedRounds> judged;
    BoostedStumps classifier;
};

/// Boosts on the other rows, and judges by the held-out ones until more rounds are of no use.
JudgedBoosting judge_rounds(const ClassifierTraining& training, const FeatureMatrix& features, const TrainingSet& set,
                            std::span<const std::uint32_t> judges, const std::function<void()>& progress) {
    const std::vector<std::int32_t> labels = chosen(training.labels, judges);
    const std::vector<float> weights = chosen(set.weights, judges);
    constexpr std::array<Link, 1> k_links{Link::softmax};
    const Patience patience = training.detailed ? k_patience_for_details : k_patience;
    Booster booster = booster_of(training, set);
    HeldOutScores scores(features, judges, training.classes);
    std::vector<JudgedRounds> judged;
    double least = training.detailed ? 1 : std::numeric_limits<double>::infinity();
    std::size_t good_rounds = 0;
    for (std::size_t round = 1; round <= training.max_rounds && round <= good_rounds + patience.rounds; ++round) {
        check_interrupt();
        booster.add_stump();
        progress();
        if (round % patience.between != 0) continue;
        scores.add(booster.classifier());
        judged.push_back({round, calibrate(scores.scores(), labels, weights, training.classes, k_links)});
        const double measure = training.detailed ? judged.back().held.error : judged.back().held.loss;
        const bool is_good = training.detailed ? measure <= least + chance_of(least, judges.size()) : measure < least;
        if (is_good) good_rounds = round;
        least = std::min(least, measure);
    }
    return {std::move(judged), booster.classifier()};
}

/// The rounds of the lowest loss or, in detail, the last ones whose error exceeds the lowest by chance at most.
JudgedRounds best_of(const ClassifierTraining& training, const std::vector<JudgedRounds>& judged,
                     std::size_t held_out) {
    if (judged.empty()) return {};
    const auto error = [](const JudgedRounds& r) { return r.held.error; };
    const auto loss = [](const JudgedRounds& r) { return r.held.loss; };
    if (!training.detailed) return *std::ranges::min_element(judged, {}, loss);
    const double least = error(*std::ranges::min_element(judged, {}, error));
    const double most = least + chance_of(least, held_out);
    return *std::find_if(judged.rbegin(), judged.rend(), [&](const JudgedRounds& r) { return error(r) <= most; });
}

}  // namespace

LearnedClassifier learn_classifier(const ClassifierTraining& training, const std::function<void()>& progress) {
    LearnedClassifier best;
    best.classifier.stumps.class_count = static_cast<std::uint32_t>(training.classes);
    if (training.classes < 2) return best;
    const StumpFeatures features = stump_features(training.features);
    const std::vector<std::uint32_t> rows = rows_where(training.held_out, 0);
    std::vector<std::uint32_t> judges = rows_where(training.held_out, 1);
    if (judges.empty()) judges = rows;
    std::vector<float> weights(training.weights.begin(), training.weights.end());
    weights.resize(training.features.rows, 1.0f);
    const QuantizedFeatures quantized = quantize(features.matrix, weights, {});
    const auto set_of = [&](std::span<const std::uint32_t> some) {
        return TrainingSet{quantized, training.labels, weights, some};
    };
    const JudgedBoosting boosting = judge_rounds(training, features.matrix, set_of(rows), judges, progress);
    const JudgedRounds chosen_rounds = best_of(training, boosting.judged, judges.size());
    const auto calibrated = [&](BoostedStumps stumps) {
        number_expanded(stumps, features.expanded);
        return CalibratedStumps{std::move(stumps), chosen_rounds.held.link, chosen_rounds.held.scale};
    };
    // The held-out rows are part of the drawing, too.
    std::vector<std::uint32_t> all(training.features.rows);
    std::iota(all.begin(), all.end(), 0U);
    best.classifier = calibrated(boosted(training, set_of(all), chosen_rounds.rounds, progress));
    best.judged = calibrated(truncate(boosting.classifier, chosen_rounds.rounds));
    best.error = chosen_rounds.held.error;
    best.loss = chosen_rounds.held.loss;
    return best;
}

std::vector<CalibratedStumps> learn_without_folds(const ClassifierTraining& training, const CalibratedStumps& like,
                                                  std::span<const std::uint8_t> fold, std::size_t folds,
                                                  const std::function<void()>& progress) {
    const StumpFeatures features = stump_features(training.features);
    std::vector<float> weights(training.weights.begin(), training.weights.end());
    weights.resize(training.features.rows, 1.0f);
    const QuantizedFeatures quantized = quantize(features.matrix, weights, {});
    std::vector<CalibratedStumps> learned;
    learned.reserve(folds);
    for (std::size_t f = 0; f < folds; ++f) {
        std::vector<std::uint32_t> rows;
        for (std::uint32_t i = 0; i < fold.size(); ++i) {
            if (fold[i] != f) rows.push_back(i);
        }
        const TrainingSet set{quantized, training.labels, weights, rows};
        BoostedStumps stumps = rows.empty() ? like.stumps : boosted(training, set, like.stumps.stumps.size(), progress);
        if (!rows.empty()) number_expanded(stumps, features.expanded);
        learned.push_back({std::move(stumps), like.link, like.scale});
    }
    return learned;
}

std::vector<float> classify(const CalibratedStumps& classifier, std::span<const std::uint32_t> which,
                            const FeatureMatrix& base, StumpScorer& scorer) {
    const std::size_t classes = classifier.stumps.class_count;
    std::vector<float> probabilities(base.rows * classes);
    if (classes < 2) {
        std::ranges::fill(probabilities, 1.0f);
        return probabilities;
    }
    const CompactStumps compact = compact_stumps(classifier.stumps, which);
    FeatureMatrix some;
    for (std::size_t first = 0; first < base.rows; first += k_rows_at_once) {
        const std::size_t count = std::min(k_rows_at_once, base.rows - first);
        expand_columns(compact.columns, base, first, count, some);
        scorer.probabilities(compact.classifier, some, classifier.link, classifier.scale,
                             std::span(probabilities).subspan(first * classes, count * classes));
    }
    return probabilities;
}

std::vector<std::string> contextual_feature_names(std::size_t labels) {
    std::vector<std::string> names;
    if (contextual_feature_count(labels) == 0) return names;
    for (std::size_t range = 0; range <= k_context_ranges; ++range) {
        for (std::size_t c = 0; c < labels; ++c) names.push_back(fmt::format("context.{}.{}", c + 1, range));
    }
    return names;
}

FeatureMatrix contextual_features(const HatchingSurface& surface, const GBuffer& gbuffer, const CoveredPixels& pixels,
                                  std::span<const float> probabilities, std::size_t labels,
                                  std::span<const std::uint32_t> rows) {
    const std::size_t columns = k_context_ranges * labels;
    const std::vector<float> at_face = mean_probabilities_around_faces(surface, gbuffer, pixels, probabilities, labels);
    FeatureMatrix matrix;
    matrix.rows = rows.empty() ? pixels.pixel.size() : rows.size();
    for (std::string& name : contextual_feature_names(labels)) {
        const std::size_t k = matrix.cols();
        const std::span<float> column = matrix.add(std::move(name));
        for (std::size_t i = 0; i < column.size(); ++i) {
            const std::size_t row = rows.empty() ? i : rows[i];
            column[i] = k < labels ? probabilities[row * labels + k]
                                   : at_face[gbuffer.face[pixels.pixel[row]] * columns + k - labels];
        }
    }
    return matrix;
}

}  // namespace exemplar
