#include "host/labeling/fold_boosting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/learn/jointboost.h"
#include "host/learn/quantize.h"

namespace exemplar {
namespace {

constexpr float k_least_probability = 1e-6F;

/// The rows of all meshes that boosting uses, side by side.
struct Pool {
    FeatureMatrix features;
    std::vector<std::int32_t> label;
    std::vector<float> weight;
    std::vector<std::uint8_t> fold;
};

/// The labeled items of a mesh, or a random part of them in rising order.
std::vector<std::uint32_t> chosen_rows(const BoostingItems& mesh, std::size_t limit, Random random) {
    std::vector<std::uint32_t> rows;
    for (std::uint32_t i = 0; i < mesh.label.size(); ++i)
        if (mesh.label[i] >= 0) rows.push_back(i);
    if (limit > 0 && rows.size() > limit) {
        random.shuffle(rows);
        rows.resize(limit);
        std::sort(rows.begin(), rows.end());
    }
    return rows;
}

Pool make_pool(std::span<const BoostingItems> meshes, const FoldBoostingOptions& options) {
    std::vector<std::vector<std::uint32_t>> rows;
    std::vector<std::size_t> offset{0};
    const Random random(options.seed);
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        rows.push_back(chosen_rows(meshes[m], options.rows_per_mesh, random.fork(m)));
        offset.push_back(offset.back() + rows.back().size());
    }
    Pool pool;
    pool.features.rows = offset.back();
    const auto& names = meshes.front().features->names;
    pool.features.names.assign(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(options.features));
    pool.features.values.resize(options.features * offset.back());
    parallel_for(options.features, [&](std::size_t f) {
        float* out = pool.features.column(f).data();
        for (std::size_t m = 0; m < meshes.size(); ++m) {
            const std::span<const float> column = meshes[m].features->column(f);
            for (const std::uint32_t row : rows[m]) *out++ = column[row];
        }
    });
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (const std::uint32_t row : rows[m]) {
            pool.label.push_back(meshes[m].label[row]);
            pool.weight.push_back(meshes[m].weight[row]);
            pool.fold.push_back(meshes[m].fold[row]);
        }
    return pool;
}

BoostResult boost(const Pool& pool, const QuantizedFeatures& quantized, std::span<const std::uint32_t> rows,
                  const ValidationSet* validation, const BoostOptions& boost_options,
                  const FoldBoostingOptions& options, const std::function<void()>& round_done) {
    const TrainingSet training{quantized, pool.label, pool.weight, rows};
    const BoostCallback callback = [&](const BoostRound&, const BoostedStumps&) { round_done(); };
    return options.binary ? train_gentleboost(training, validation, boost_options, callback)
                          : train_jointboost(training, options.classes, validation, boost_options, callback);
}

/// Mean over the folds; one that stopped early counts on with its last value.
std::vector<double> mean_curve(const std::vector<std::vector<BoostRound>>& curves) {
    std::size_t rounds = 0;
    for (const auto& curve : curves) rounds = std::max(rounds, curve.size());
    std::vector<double> mean(rounds, 0);
    for (const auto& curve : curves)
        for (std::size_t r = 0; r < rounds && !curve.empty(); ++r)
            mean[r] += curve[std::min(r, curve.size() - 1)].validation_error / static_cast<double>(curves.size());
    return mean;
}

/// Whether both sides of a fold have rows to learn from and to judge by.
bool splits(const std::vector<std::uint32_t>& inside, const std::vector<std::uint32_t>& outside) {
    return !inside.empty() && !outside.empty();
}

struct FoldModels {
    std::vector<BoostedStumps> of_fold;  ///< empty where a fold could not be trained
    std::vector<double> curve;
    std::size_t rounds = 0;
};

FoldModels train_folds(const Pool& pool, const QuantizedFeatures& quantized, const FoldBoostingOptions& options,
                       const std::function<void()>& round_done) {
    FoldModels models;
    models.of_fold.resize(options.folds);
    std::vector<std::vector<BoostRound>> curves;
    BoostOptions boost_options;
    boost_options.rounds = options.rounds, boost_options.patience = options.patience, boost_options.seed = options.seed;
    boost_options.keep_best = false;
    boost_options.monitor = BoostMonitor::error;
    for (std::size_t fold = 0; fold < options.folds && options.folds > 1; ++fold) {
        check_interrupt();
        std::vector<std::uint32_t> inside, outside;
        for (std::uint32_t row = 0; row < pool.fold.size(); ++row)
            (pool.fold[row] == fold ? outside : inside).push_back(row);
        if (!splits(inside, outside)) continue;
        const ValidationSet validation{pool.features, pool.label, pool.weight, outside};
        BoostResult result = boost(pool, quantized, inside, &validation, boost_options, options, round_done);
        models.of_fold[fold] = std::move(result.classifier);
        curves.push_back(std::move(result.curve));
    }
    models.curve = mean_curve(curves);
    models.rounds = std::min<std::size_t>(options.rounds, 50);  // nothing could be held out: stay cautious
    if (!models.curve.empty())
        models.rounds = static_cast<std::size_t>(std::min_element(models.curve.begin(), models.curve.end()) -
                                                 models.curve.begin()) +
                        1;
    return models;
}

/// Probabilities of every item of every mesh from the classifier of the fold that held it out, for one link.
std::vector<std::vector<float>> score_out_of_fold(std::span<const BoostingItems> meshes, const FoldModels& models,
                                                  const BoostedStumps& fallback, std::size_t classes, Link link,
                                                  float scale, StumpScorer& scorer) {
    std::vector<std::vector<float>> result;
    for (const BoostingItems& mesh : meshes) {
        std::vector<float> scores(mesh.fold.size() * classes);
        std::vector<float> of_fold(scores.size());
        for (std::size_t fold = 0; fold < models.of_fold.size(); ++fold) {
            const auto holds = [&](std::uint8_t f) { return f == fold; };
            if (std::none_of(mesh.fold.begin(), mesh.fold.end(), holds)) continue;
            const BoostedStumps& classifier = models.of_fold[fold].class_count ? models.of_fold[fold] : fallback;
            scorer.probabilities(classifier, *mesh.features, link, scale, of_fold);
            for (std::size_t i = 0; i < mesh.fold.size(); ++i)
                if (mesh.fold[i] == fold)
                    std::copy_n(of_fold.begin() + i * classes, classes, scores.begin() + i * classes);
        }
        result.push_back(std::move(scores));
    }
    return result;
}

/// Weighted mean of -log P(truth) and weighted share of wrong labels.
std::pair<double, double> judge(std::span<const BoostingItems> meshes,
                                const std::vector<std::vector<float>>& probabilities, std::size_t classes) {
    double loss = 0, wrong = 0, total = 0;
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (std::size_t i = 0; i < meshes[m].label.size(); ++i) {
            const std::int32_t truth = meshes[m].label[i];
            if (truth < 0) continue;
            const float* p = probabilities[m].data() + i * classes;
            const double weight = meshes[m].weight[i];
            loss -= weight * std::log(std::max(p[truth], k_least_probability));
            wrong += std::max_element(p, p + classes) - p == truth ? 0 : weight;
            total += weight;
        }
    return total > 0 ? std::pair{loss / total, wrong / total} : std::pair{0.0, 0.0};
}

/// Chooses the link and its scale by the out-of-fold loss, and keeps the probabilities of the best.
void calibrate(std::span<const BoostingItems> meshes, const FoldModels& models, const FoldBoostingOptions& options,
               StumpScorer& scorer, FoldBoostingResult& result) {
    result.loss = std::numeric_limits<double>::infinity();
    for (const Link link : {Link::softmax, Link::sigmoid}) {
        if (options.binary && link == Link::sigmoid) continue;  // GentleBoost's class 0 has no score of its own
        for (const float scale : {0.5F, 0.7F, 1.0F, 1.4F, 2.0F, 2.8F}) {
            check_interrupt();
            auto scores =
                score_out_of_fold(meshes, models, result.classifier.stumps, options.classes, link, scale, scorer);
            const auto [loss, error] = judge(meshes, scores, options.classes);
            if (loss >= result.loss) continue;
            result.loss = loss, result.error = error;
            result.classifier.link = link, result.classifier.scale = scale;
            result.out_of_fold = std::move(scores);
        }
    }
}

}  // namespace

FoldBoostingResult boost_with_folds(std::span<const BoostingItems> meshes, const FoldBoostingOptions& options,
                                    StumpScorer& scorer, const std::function<void()>& round_done) {
    const Pool pool = make_pool(meshes, options);
    if (pool.label.empty()) throw DataError("no face of the training meshes has a label");
    QuantizeOptions quantize_options;
    quantize_options.bins = options.bins;
    const QuantizedFeatures quantized = quantize(pool.features, pool.weight, quantize_options);
    FoldModels models = train_folds(pool, quantized, options, round_done);
    for (BoostedStumps& model : models.of_fold)
        if (model.class_count) model = truncate(model, models.rounds);

    BoostOptions all;
    all.rounds = models.rounds, all.patience = 0, all.seed = options.seed;
    FoldBoostingResult result;
    result.classifier.stumps = boost(pool, quantized, {}, nullptr, all, options, round_done).classifier;
    result.curve = models.curve;
    calibrate(meshes, models, options, scorer, result);
    return result;
}

}  // namespace exemplar
