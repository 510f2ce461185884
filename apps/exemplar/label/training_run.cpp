#include "apps/exemplar/label/training_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "host/core/interrupt.h"
#include "host/core/progress.h"

namespace exemplar {

namespace fs = std::filesystem;

std::vector<MeshFeatures> features_of(const LabeledCorpus& corpus, const FeatureOptions& options,
                                      const fs::path& cache) {
    Progress progress("computing features", corpus.meshes.size());
    std::vector<MeshFeatures> features;
    for (const LabeledMesh& mesh : corpus.meshes) {
        check_interrupt();
        features.push_back(cached_features(mesh.mesh, options, cache));
        progress.advance(1, mesh.name);
    }
    return features;
}

TrainingFeatures training_features(const LabeledCorpus& corpus, const FeatureOptions& options, const fs::path& cache,
                                   double gigabytes) {
    Progress progress("computing features", corpus.meshes.size());
    TrainingFeatures::Source source;
    source.load = [&corpus, options, cache](std::size_t mesh) {
        check_interrupt();
        return cached_features(corpus.meshes[mesh].mesh, options, cache);
    };
    source.is_stored = [&corpus, options, cache](std::size_t mesh) {
        return !cache.empty() && fs::exists(cache / feature_entry_name(corpus.meshes[mesh].mesh, options));
    };
    return {corpus.meshes.size(), std::move(source), static_cast<std::size_t>(gigabytes * 1e9),
            [&](std::size_t mesh) { progress.advance(1, corpus.meshes[mesh].name); }};
}

void add_feature_memory_option(Command& command, double& gigabytes) {
    command
        .add_option(
            "--feature-memory", gigabytes,
            "GB of training meshes' features to keep in memory; others are read from --cache again, if there is one")
        ->capture_default_str()
        ->check(in_range(0.0, 1e6));
}

std::vector<std::pair<std::string, std::size_t>> stumps_per_family(const LabelingModel& model,
                                                                   std::optional<std::size_t> stage) {
    const std::vector<std::string> context = context_names(model.label_names);
    std::map<std::string, std::size_t> count;
    for (std::size_t k = 0; k < model.unary.size(); ++k) {
        if (stage && k != *stage) continue;
        for (const Stump& stump : model.unary[k].stumps.stumps) {
            const std::size_t base = model.unary_names.size();
            const std::string& name =
                stump.feature < base ? model.unary_names[stump.feature] : context[stump.feature - base];
            ++count[name.substr(0, name.find('.'))];
        }
    }
    std::vector<std::pair<std::string, std::size_t>> families(count.begin(), count.end());
    std::stable_sort(families.begin(), families.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    return families;
}

std::vector<std::string> first_features(const LabelingModel& model, std::size_t count) {
    std::vector<std::string> names;
    for (const Stump& stump : model.unary.front().stumps.stumps) {
        if (names.size() == count) break;
        names.push_back(model.unary_names[stump.feature]);
    }
    return names;
}

nlohmann::json describe_options(const TrainOptions& options) {
    return {{"seed", options.seed},
            {"rounds", options.rounds},
            {"patience", options.patience},
            {"stages", options.max_stages},
            {"bins", options.bins},
            {"rows", options.rows_per_mesh},
            {"feature_fraction", options.feature_fraction},
            {"shrinkage", options.shrinkage},
            {"linear", options.linear},
            {"boundary", options.boundary},
            {"samples", options.features.samples},
            {"orientation", orientation_uses()[static_cast<std::size_t>(options.orientation)]},
            {"features", k_feature_version},
            {"training", k_training_version},
            {"format", k_model_format_version}};
}

namespace {

std::string number_or_dash(double value, int digits) {
    return std::isnan(value) ? std::string("-") : fmt::format("{:.{}f}", value, digits);
}

}  // namespace

void print_training(const LabelingModel& model, const TrainReport& report) {
    fmt::print("{:>14} {:>7} {:>9} {:>9} {:>9} {:>8}\n", "classifier", "stumps", "loss", "pooled", "error %",
               "seconds");
    for (const StageReport& stage : report.stages)
        fmt::print("{:>14} {:>7} {:>9} {:>9} {:>9} {:>8.1f}{}\n", stage.what, stage.rounds,
                   number_or_dash(stage.stumps_loss, 4), number_or_dash(stage.validation_loss, 4),
                   number_or_dash(100 * stage.validation_error, 2), stage.seconds, stage.kept ? "" : "  (left out)");
    fmt::print(
        "CRF: kappa {:.3g}, lambda {:.3g}, mu {:.3g}; segment-weighted error {:.2f} % without, {:.2f} % with the cut "
        "({} settings in {:.1f} s)\n",
        model.crf.kappa, model.crf.lambda, model.crf.mu, 100 * report.crf.error_without_cut, 100 * report.crf.error,
        report.crf.evaluations, report.crf_seconds);
}

nlohmann::json describe_training(const LabelingModel& model, const TrainReport& report) {
    nlohmann::json stages = nlohmann::json::array();
    for (const StageReport& stage : report.stages) {
        nlohmann::json curve = nlohmann::json::array();
        for (const HeldOutPoint& point : stage.curve)
            curve.push_back({{"rounds", point.rounds}, {"loss", point.loss}, {"error", point.error}});
        stages.push_back({{"classifier", stage.what},
                          {"stumps", stage.rounds},
                          {"validation_loss", stage.validation_loss},
                          {"stumps_loss", stage.stumps_loss},
                          {"validation_error", stage.validation_error},
                          {"kept", stage.kept},
                          {"curve", std::move(curve)},
                          {"seconds", stage.seconds}});
    }
    nlohmann::json families;
    for (const auto& [family, count] : stumps_per_family(model)) families[family] = count;
    return {{"labels", model.label_names},
            {"training_meshes", model.provenance},
            {"folds", report.folds},
            {"classifiers", stages},
            {"crf",
             {{"kappa", model.crf.kappa},
              {"lambda", model.crf.lambda},
              {"mu", model.crf.mu},
              {"compatibility", model.crf.compatibility},
              {"merge_fraction", model.crf.merge_fraction},
              {"error_without_cut", report.crf.error_without_cut},
              {"error", report.crf.error},
              {"evaluations", report.crf.evaluations},
              {"seconds", report.crf_seconds}}},
            {"stumps_per_family", families},
            {"first_features", first_features(model, 10)}};
}

}  // namespace exemplar
