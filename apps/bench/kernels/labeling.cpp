// Contextual label histograms of random geometry, and a cascade that uses them: 1000 samples, 8 classes.

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "apps/bench/kernels/operation.h"
#include "embedded/labeling_context_axes_comp.h"
#include "embedded/labeling_context_geodesic_comp.h"
#include "embedded/labeling_context_linear_comp.h"
#include "embedded/labeling_context_masses_comp.h"
#include "embedded/labeling_context_prefixes_comp.h"
#include "embedded/labeling_context_ranks_comp.h"
#include "embedded/labeling_prediction_comp.h"
#include "embedded/learn_stumps_comp.h"
#include "gpu/labeling/cascade.h"
#include "gpu/labeling/context_histograms.h"
#include "gpu/learn/stump_scorer.h"
#include "host/core/random.h"
#include "host/labeling/features/fast_context.h"
#include "host/labeling/inference/labeler.h"

namespace exemplar {
namespace {

constexpr std::size_t k_label_classes = 8, k_samples = 1000;
constexpr std::size_t k_context_columns = k_context_measures * k_context_bins * k_label_classes;

ContextGeometry random_geometry(std::size_t faces, Random& random) {
    ContextGeometry geometry;
    geometry.faces = faces;
    for (std::size_t j = 0; j < k_samples; ++j)
        geometry.sample_face.push_back(static_cast<std::uint32_t>(random.index(faces)));
    geometry.sample_area.assign(k_samples, 1.0f / k_samples);
    geometry.geodesic_bin.resize(k_samples * faces);
    for (std::uint8_t& bin : geometry.geodesic_bin) bin = static_cast<std::uint8_t>(random.next() % k_context_bins);
    geometry.axis_position.resize(k_context_axes * faces);
    for (float& position : geometry.axis_position) position = static_cast<float>(random.uniform(0.0, 2.0));
    for (auto& edges : geometry.axis_edges) edges = {0.2f, 0.5f, 0.95f, 1.5f};
    return geometry;
}

// The work of histograms, once. Geodesic ranges: half a byte per sample, and a sum per class. Axes: two binary searches
// per inner edge, three sums per bin and class.
std::map<std::string, Work> histogram_work(std::size_t face_count) {
    const auto faces = static_cast<double>(face_count);
    const double searches = k_context_axes * 2 * (k_context_bins - 1) * std::log2(k_samples);
    const double of_axes = k_context_axes * k_context_bins * k_label_classes;
    const double masses = k_samples * k_label_classes;
    return {{"labeling/context_masses.comp", {.bytes = 8 * k_samples + 8 * masses, .operations = masses}},
            {"labeling/context_prefixes.comp",
             {.bytes = 4 * k_context_axes * k_samples + 4 * masses * (1 + k_context_axes),
              .operations = k_context_axes * masses}},
            {"labeling/context_geodesic.comp",
             {.bytes = faces * (0.5 * k_samples + 4 * k_context_bins * k_label_classes),
              .operations = faces * k_samples * k_label_classes}},
            {"labeling/context_axes.comp",
             {.bytes = faces * 4 * (k_context_axes + of_axes), .operations = faces * (2 * searches + 3 * of_axes)}}};
}

struct Histograms {
    Histograms(Device& device, Profiler& profiler, std::size_t faces)
        : geometry(random_geometry(faces, random)),
          probabilities(faces * k_label_classes, 1.0f / k_label_classes),
          actual(k_context_columns * faces),
          histograms(device, &profiler) {}
    void run() { histograms.accumulate(geometry, probabilities, k_label_classes, actual); }
    std::vector<Difference> differences() const {
        std::vector<float> expected(actual.size());
        CpuContextHistograms().accumulate(geometry, probabilities, k_label_classes, expected);
        return {{"histograms", largest_difference(actual, expected), 1e-5}};
    }
    std::map<std::string, Work> work() const { return histogram_work(geometry.faces); }
    Random random{2};
    ContextGeometry geometry;
    std::vector<float> probabilities, actual;
    GpuContextHistograms histograms;
};

constexpr std::size_t k_base_features = 40, k_stage_stumps = 300;

CalibratedStumps random_classifier(std::size_t context, Random& random) {
    CalibratedStumps stage;
    stage.stumps.class_count = k_label_classes;
    for (std::size_t m = 0; m < k_stage_stumps; ++m) {
        const bool of_context = m % 2 == 0 && context > 0;
        const std::size_t feature =
            of_context ? k_base_features + random.index(context) : random.index(k_base_features);
        const double threshold = of_context ? random.uniform(0, 0.1) : random.normal();
        stage.stumps.stumps.push_back({static_cast<std::uint32_t>(feature), static_cast<float>(threshold),
                                       static_cast<float>(random.uniform(-0.2, 0.2)),
                                       static_cast<float>(random.uniform(-0.2, 0.2)), 1 + random.index(255)});
    }
    stage.stumps.elsewhere.assign(k_stage_stumps * k_label_classes, 0.0f);
    return stage;
}

LinearExpert random_expert(std::size_t context, Random& random) {
    LinearExpert expert;
    expert.ratio = 2;
    LinearClassifier& linear = expert.classifier;
    linear.class_count = k_label_classes;
    linear.constant.assign(k_label_classes, 0.3f);
    for (std::size_t f = 0; f < k_base_features + context; ++f) {
        linear.mean.push_back(f < k_base_features ? 0.0f : 0.03f);
        linear.inverse.push_back(f < k_base_features ? 1.0f : 20.0f);
        for (std::size_t c = 0; c < k_label_classes; ++c)
            linear.weight.push_back(static_cast<float>(random.uniform(-0.03, 0.03)));
    }
    return expert;
}

// Two stages of stumps and linear classifiers, and nothing about edges.
LabelingModel random_cascade(Random& random) {
    LabelingModel model;
    for (std::size_t c = 0; c < k_label_classes; ++c) model.label_names.push_back(fmt::format("label {}", c));
    for (std::size_t f = 0; f < k_base_features; ++f) model.unary_names.push_back(fmt::format("feature {}", f));
    for (const std::size_t context : {std::size_t{0}, k_context_columns}) {
        model.unary.push_back(random_classifier(context, random));
        model.linear.push_back(random_expert(context, random));
    }
    return model;
}

struct Cascade {
    Cascade(Device& device, Profiler& profiler, std::size_t faces)
        : model(random_cascade(random)), scorer(device), histograms(device), cascade(device, scorer, &profiler) {
        mesh.unary.rows = faces;
        for (const std::string& name : model.unary_names)
            for (float& value : mesh.unary.add(name)) value = static_cast<float>(random.normal());
        mesh.context = random_geometry(faces, random);
    }
    // One classifier after the other, without times, where the device's limits are too low.
    void run() {
        MeshFeatures* const one = &mesh;
        actual =
            std::move(score_faces(model, std::span(&one, 1), {scorer, histograms, &cascade}).front().probabilities);
    }
    // Host and device round differently. A histogram that lies within rounding of a threshold may fall on its other
    // side, and then that face has other probabilities.
    std::vector<Difference> differences() const {
        CpuStumpScorer stumps;
        FastContextHistograms context;
        MeshFeatures copy = mesh;
        MeshFeatures* const one = &copy;
        const std::vector<float> expected =
            score_faces(model, std::span(&one, 1), {stumps, context}).front().probabilities;
        std::size_t others = 0;
        for (std::size_t i = 0; i < expected.size(); i += k_label_classes)
            others += largest_difference(std::span(actual).subspan(i, k_label_classes),
                                         std::span(expected).subspan(i, k_label_classes)) > 1e-5
                          ? 1
                          : 0;
        const auto faces = static_cast<double>(mesh.unary.rows);
        return {{"share of faces with other probabilities", static_cast<double>(others) / faces, 2e-3}};
    }
    // Ranks: a comparison per threshold. Linear classifier: four operations per column, a product and a sum per class.
    // In both stages, the prediction: the logarithm, exp, two products, two sums, a maximum and a quotient per class;
    // and stumps: a comparison, a selection and a sum, and five operations per class.
    std::map<std::string, Work> work() const {
        const auto faces = static_cast<double>(mesh.unary.rows);
        std::vector<FeatureThresholds> columns = thresholds_of(model.unary[1].stumps.stumps);
        std::erase_if(columns, [](const FeatureThresholds& column) { return column.feature < k_base_features; });
        double thresholds = 0;
        for (const FeatureThresholds& column : columns) thresholds += static_cast<double>(column.thresholds.size());
        const double values = faces * k_label_classes, ranks = faces * static_cast<double>(columns.size());
        std::map<std::string, Work> all = histogram_work(mesh.unary.rows);
        all["labeling/context_ranks.comp"] = {.bytes = 5 * ranks, .operations = faces * thresholds};
        all["labeling/context_linear.comp"] = {.bytes = 8 * values + 4 * faces * k_context_columns,
                                               .operations = faces * k_context_columns * (4 + 2 * k_label_classes)};
        all["labeling/prediction.comp"] = {.bytes = 2 * 12 * values, .operations = 2 * 8 * values};
        all["learn/stumps.comp"] = {.bytes = 2 * (faces * k_base_features + 4 * values) + ranks,
                                    .operations = 2 * (faces * 3 * k_stage_stumps + 5 * values)};
        return all;
    }
    Random random{3};
    LabelingModel model;
    MeshFeatures mesh;
    std::vector<float> actual;
    GpuStumpScorer scorer;
    GpuContextHistograms histograms;
    GpuCascade cascade;
};

}  // namespace

std::vector<OperationKind> labeling_operations() {
    return {{"contextual histograms",
             "faces",
             {5'000, 20'000, 100'000},
             {&shaders::labeling_context_masses_comp, &shaders::labeling_context_prefixes_comp,
              &shaders::labeling_context_geodesic_comp, &shaders::labeling_context_axes_comp},
             {k_context_faces},
             prepare_as<Histograms>},
            {"cascade of labels",
             "faces",
             {5'000, 20'000},
             {&shaders::labeling_context_masses_comp, &shaders::labeling_context_prefixes_comp,
              &shaders::labeling_context_geodesic_comp, &shaders::labeling_context_axes_comp,
              &shaders::labeling_context_ranks_comp, &shaders::labeling_context_linear_comp,
              &shaders::labeling_prediction_comp, &shaders::learn_stumps_comp},
             {k_linear_rows},
             prepare_as<Cascade>}};
}

}  // namespace exemplar
