// A model labels meshes that were damaged on purpose: what must not matter does not, and nothing breaks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "host/data/corpus.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/labeling/training/training.h"
#include "host/synth/damage/damage.h"
#include "host/synth/shapes/shapes.h"

namespace exemplar {
namespace {

constexpr std::size_t k_faces = 1000;
constexpr std::uint64_t k_seed = 5;

class DamagedLabeling : public testing::Test {
  protected:
    void SetUp() override {
        LabeledCorpus corpus;
        TrainOptions options;
        options.rounds = 15, options.max_stages = 2, options.rows_per_mesh = 300, options.features.samples = 100;
        std::vector<MeshFeatures> features;
        for (std::uint64_t i = 1; i <= 3; ++i) {
            SynthShape shape = make_shape("octopus", i, k_faces);
            corpus.names = shape.labels.names;
            corpus.meshes.push_back(
                {"octopus" + std::to_string(i), {}, std::move(shape.mesh), std::move(shape.labels.label)});
            features.push_back(compute_features(corpus.meshes.back().mesh, options.features));
        }
        TrainReport report;
        model_ = train_labeling(corpus, features, options, {scorer_, context_}, report);
        mesh_ = make_shape("octopus", 100, k_faces).mesh;
        label_ = label_mesh(model_, mesh_, {}, {scorer_, context_}).label;
        const auto tentacles = static_cast<std::size_t>(std::ranges::count(label_, 1));
        ASSERT_GT(tentacles, k_faces / 4) << "both parts are found, or nothing below would mean much";
        ASSERT_LT(tentacles, k_faces * 9 / 10);
    }

    /// Labels a damaged mesh; returns the share of its area whose label is that of where it came from.
    double unchanged_share(std::string_view damage) {
        const DamagedMesh damaged = damage_named(damage).apply(mesh_, k_seed);
        const FaceLabeling labeling = label_mesh(model_, damaged.mesh, {}, {scorer_, context_});
        EXPECT_EQ(labeling.label.size(), damaged.mesh.face_count());
        for (const std::int32_t label : labeling.label) EXPECT_TRUE(label == 0 || label == 1);
        for (const float p : labeling.probabilities) EXPECT_TRUE(p >= 0 && p <= 1) << p;  // so no NaN either
        for (const float p : labeling.confidence) EXPECT_TRUE(p >= 0 && p <= 1) << p;
        const std::vector<float> area = face_areas(damaged.mesh);
        double same = 0, total = 0;
        for (std::size_t f = 0; f < area.size(); ++f) {
            total += static_cast<double>(area[f]);
            if (labeling.label[f] == label_[damaged.origin[f]]) same += static_cast<double>(area[f]);
        }
        return same / total;
    }

    CpuStumpScorer scorer_;
    CpuContextHistograms context_;
    LabelingModel model_;
    TriangleMesh mesh_;
    std::vector<std::int32_t> label_;
};

TEST_F(DamagedLabeling, KeepsItsLabels) {
    // The same surface, moved or named differently: only rounding, and what follows from it, may differ.
    const std::map<std::string_view, double> harmless{
        {"inside-out", 0.995}, {"rotated", 0.99},  {"scaled-down", 0.99},     {"scaled-up", 0.99},
        {"far-away", 0.99},    {"shuffled", 0.99}, {"loose-vertices", 0.995}, {"duplicated-faces", 0.99},
        {"slivers", 0.98},     {"unwelded", 0.99}, {"split-parts", 0.99}};
    // Other faces stand for the same surface, so that borders can move by a face (here 3% of the shape's size).
    const std::map<std::string_view, double> mild{{"quads", 0.96},         {"refined-4x", 0.96},  {"refined-9x", 0.96},
                                                  {"flipped-faces", 0.96}, {"fins", 0.96},        {"holes", 0.95},
                                                  {"noise", 0.96},         {"strong-noise", 0.94}};
    for (const Damage& damage : damages()) {
        SCOPED_TRACE(damage.name);
        const double unchanged = unchanged_share(damage.name);  // which checks that labels and probabilities are sound
        if (const auto it = harmless.find(damage.name); it != harmless.end()) {
            EXPECT_GE(unchanged, it->second);
        }
        if (const auto it = mild.find(damage.name); it != mild.end()) {
            EXPECT_GE(unchanged, it->second);
        }
        // A tenth of them, a hundred faces, are too few for eight tentacles: nothing is promised.
    }
}

}  // namespace
}  // namespace exemplar
