#include "apps/exemplar/label/learning_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/interrupt.h"
#include "host/core/random.h"
#include "host/labeling/evaluation/evaluation.h"
#include "host/labeling/evaluation/learning_curve.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/labeling/painting/shape_order.h"
#include "host/labeling/painting/suggestions.h"

namespace exemplar {
namespace {

using Json = nlohmann::json;

constexpr std::size_t k_more_shapes = 3;  ///< whose gain is predicted

/// 1, 2, 3, 4, 6, 8, 12, 16, ... below `count`, then `count`.
std::vector<std::size_t> curve_sizes(std::size_t count) {
    std::vector<std::size_t> sizes;
    for (std::size_t power = 1; power < count; power *= 2)
        for (const std::size_t size : {power, power + power / 2})
            if (size < count && (sizes.empty() || size > sizes.back())) sizes.push_back(size);
    sizes.push_back(count);
    return sizes;
}

/// The models of growing parts of the training meshes; null where fewer than two labels occur.
std::vector<std::unique_ptr<LabelingModel>> train_models(const LabeledCorpus& corpus,
                                                         const std::vector<std::size_t>& order,
                                                         const std::vector<std::size_t>& sizes, DeviceBackend& backend,
                                                         const std::filesystem::path& cache, std::uint64_t seed) {
    TrainOptions options = suggestion_training();
    options.seed = seed;
    std::vector<std::unique_ptr<LabelingModel>> models;
    for (const std::size_t size : sizes) {
        LabeledCorpus part{corpus.names, {}, {}};
        for (std::size_t i = 0; i < size; ++i) part.meshes.push_back(corpus.meshes[order[i]]);
        part = without_unused_labels(std::move(part));
        models.emplace_back();
        if (part.names.size() < 2) continue;
        std::vector<MeshFeatures> features = features_of(part, options.features, cache);
        TrainReport report;
        models.back() =
            std::make_unique<LabelingModel>(train_labeling(part, features, options, backend.labeling(), report));
    }
    return models;
}

}  // namespace

Json learning_curve_of(const EvaluationTask& task, DeviceBackend& backend, const std::filesystem::path& cache,
                       std::uint64_t seed) {
    std::vector<std::filesystem::path> paths = task.train;
    paths.insert(paths.end(), task.test.begin(), task.test.end());
    const LabeledCorpus corpus = working_corpus(load_corpus(paths, {}, task.labels));
    std::vector<std::size_t> order(task.train.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    Random(seed).shuffle(order);
    const std::vector<std::size_t> sizes = curve_sizes(order.size());
    const auto models = train_models(corpus, order, sizes, backend, cache, seed);

    std::vector<double> error(sizes.size(), 0);
    std::vector<ShapeDescriptor> descriptors;
    std::vector<float> uncertainty;
    for (std::size_t m = 0; m < corpus.meshes.size(); ++m) {
        check_interrupt();
        const LabeledMesh& mesh = corpus.meshes[m];
        MeshFeatures features = cached_features(mesh.mesh, suggestion_training().features, cache);
        descriptors.push_back(compute_shape_descriptor(features));
        uncertainty.push_back(0);
        if (m < task.train.size()) continue;
        MeshFeatures* const one = &features;
        for (std::size_t k = 0; k < sizes.size(); ++k) {
            if (!models[k]) {
                error[k] += 1.0 / static_cast<double>(task.test.size());
                continue;
            }
            const Suggestion suggestion =
                std::move(suggest_labels(*models[k], std::span(&one, 1), corpus.names, backend.labeling()).front());
            drop_context_columns(features);
            const MeshScore score =
                score_labeling(face_areas(mesh.mesh), mesh.label, suggestion.labels.label, corpus.names.size());
            error[k] += (1 - score.recognition_rate) / static_cast<double>(task.test.size());
            uncertainty.back() = std::max(uncertainty_of(features.face_area, suggestion.labels.confidence), 1e-3F);
        }
    }
    Json points = Json::array();
    std::vector<LearningPoint> measured;
    for (std::size_t k = 0; k < sizes.size(); ++k) {
        points.push_back({{"shapes", sizes[k]}, {"recognition_rate", 1 - error[k]}});
        measured.push_back({sizes[k], error[k]});
    }
    Json curve{{"points", points}};
    if (measured.size() >= 3) {
        const PowerLaw law = fit_power_law(measured);
        const auto count = static_cast<double>(order.size());
        curve["expected_gain"] = law.error(count) - law.error(count + k_more_shapes);
    }
    const std::vector<std::size_t> next = order_by_gain(ShapeLikeness(descriptors), uncertainty, corpus.names.size());
    if (!next.empty()) curve["label_next"] = corpus.meshes[next.front()].path.string();
    return curve;
}

std::string learning_curve_text(const Json& curve) {
    std::string text;
    for (const Json& point : curve["points"])
        text += fmt::format("{}{} {}: {:.1f} %", text.empty() ? "" : ", ", point["shapes"].get<std::size_t>(),
                            point["shapes"] == 1 ? "shape" : "shapes", 100 * point["recognition_rate"].get<double>());
    if (curve.contains("expected_gain"))
        text += fmt::format("; {} more: about +{:.1f} %", k_more_shapes, 100 * curve["expected_gain"].get<double>());
    if (curve.contains("label_next"))
        text += fmt::format("; label next: {}",
                            std::filesystem::path(curve["label_next"].get<std::string>()).filename().string());
    return text;
}

}  // namespace exemplar
