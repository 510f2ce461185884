// Trains JointBoost on rows, as the first classifier of 'exemplar label train' is trained, and scores other rows.
//   compare_boost IN OUT
// IN, a safetensors file: x (features x rows), label (rows, I32), weight (rows), fold (rows, U8: which one holds the
// row out), test (features x rows), and in its metadata classes, folds (1: a single classifier, as in the thesis,
// instead of the mean of those of the folds), linear (1: pooled with a linear classifier; needs folds), rounds,
// shrinkage, feature_fraction and threads. OUT: probability (test rows x classes), with folds also held_out (rows x
// classes), and in its metadata the CPU seconds train_seconds and score_seconds.

#include <fmt/format.h>

#include <exception>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/stopwatch.h"
#include "host/data/safetensors.h"
#include "host/labeling/training/fold_boosting.h"
#include "host/learn/boosting/jointboost.h"

namespace exemplar {
namespace {

FeatureMatrix feature_matrix(const TensorFile& file, const std::string& name) {
    FeatureMatrix features;
    features.values = file.get<float>(name, {TensorFile::k_any, TensorFile::k_any});
    const std::vector<std::size_t>& shape = file.tensors.at(name).shape;
    features.rows = shape[1];
    for (std::size_t k = 0; k < shape[0]; ++k) features.names.push_back(fmt::format("x{}", k));
    return features;
}

struct Rows {
    FeatureMatrix features;
    std::vector<std::int32_t> label;
    std::vector<float> weight;
    std::vector<std::uint8_t> fold;
};

Rows training_rows(const TensorFile& file) {
    Rows rows{feature_matrix(file, "x"), {}, {}, {}};
    rows.label = file.get<std::int32_t>("label", {rows.features.rows});
    rows.weight = file.get<float>("weight", {rows.features.rows});
    rows.fold = file.get<std::uint8_t>("fold", {rows.features.rows});
    return rows;
}

FoldBoostingOptions boosting_options(const TensorFile& file, const Rows& rows) {
    FoldBoostingOptions options;
    options.classes = std::stoul(file.meta("classes"));
    options.features = rows.features.cols();
    options.folds = std::stoul(file.meta("folds"));
    options.rounds = std::stoul(file.meta("rounds"));
    options.patience = 0;
    options.linear = file.meta("linear") == "1";
    options.shrinkage = std::stod(file.meta("shrinkage"));
    options.feature_fraction = std::stod(file.meta("feature_fraction"));
    return options;
}

/// One classifier that learned from all rows; its scores are used as they are (thesis Eq. 2.66).
CalibratedStumps single_classifier(const Rows& rows, const FoldBoostingOptions& options) {
    BoostOptions boost;
    boost.rounds = options.rounds;
    boost.shrinkage = options.shrinkage, boost.feature_fraction = options.feature_fraction;
    QuantizeOptions quantization;
    quantization.bins = options.bins;
    const QuantizedFeatures quantized = quantize(rows.features, rows.weight, quantization);
    return {train_jointboost({quantized, rows.label, rows.weight, {}}, options.classes, boost).classifier};
}

void boost(const char* in, const char* out) {
    const TensorFile file = read_safetensors(in);
    const Rows rows = training_rows(file);
    const FoldBoostingOptions options = boosting_options(file, rows);
    const FeatureMatrix test = feature_matrix(file, "test");
    const ThreadLimit limit(std::stoul(file.meta("threads")));
    CpuStumpScorer scorer;
    TensorFile result;

    const Stopwatch training;
    CalibratedStumps classifier;
    LinearExpert linear;
    std::vector<std::uint32_t> stump_only_labels;
    if (options.folds > 1) {
        const BoostingItems items{[&]() -> const FeatureMatrix& { return rows.features; }, rows.label, rows.weight,
                                  rows.fold};
        FoldBoostingResult found = boost_with_folds(std::span(&items, 1), options, scorer, [] {});
        classifier = std::move(found.classifier);
        linear = std::move(found.linear), stump_only_labels = std::move(found.single_fold_labels);
        result.add("held_out", {rows.label.size(), options.classes}, found.out_of_fold.front());
    } else {
        classifier = single_classifier(rows, options);
    }
    result.metadata["train_seconds"] = fmt::format("{:.6f}", training.cpu());

    const Stopwatch scoring;
    std::vector<float> probability(test.rows * options.classes);
    scorer.probabilities(classifier.stumps, test, classifier.link, classifier.scale, probability);
    pool(linear, test, stump_only_labels, probability);
    result.metadata["score_seconds"] = fmt::format("{:.6f}", scoring.cpu());
    result.add("probability", {test.rows, options.classes}, probability);
    write_safetensors(out, result);
}

}  // namespace
}  // namespace exemplar

int main(int count, char** arguments) {
    try {
        if (count != 3) throw exemplar::UsageError("expected 2 arguments, see the head of boost.cpp");
        exemplar::boost(arguments[1], arguments[2]);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return 1;
    }
}
