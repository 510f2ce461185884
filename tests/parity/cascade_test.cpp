#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "gpu/labeling/cascade.h"
#include "gpu/labeling/context_histograms.h"
#include "gpu/learn/stump_scorer.h"
#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/labeling/inference/labeler.h"
#include "tests/gpu/support/environment.h"
#include "tests/support/random_context.h"

// The cascade on the device, held to the same classifiers one by one on the host. Both compare histograms with
// thresholds; these are sums of 1 in all, which differ by about 1e-6. So a face may get another answer where a
// histogram lies that near to a threshold: one of several thousand comparisons in ten thousand.
namespace exemplar {
namespace {

constexpr float k_probability_tolerance = 2e-5F;
constexpr double k_most_other_answers = 0.01;  // of all faces or edges
constexpr std::size_t k_face_features = 30, k_edge_features = 20;

void add_columns(FeatureMatrix& matrix, std::size_t columns, const std::string& name, Random& random) {
    for (std::size_t c = 0; c < columns; ++c)
        for (float& value : matrix.add(name + std::to_string(c))) value = static_cast<float>(random.normal());
}

// Features and geometry that no surface has, of any numbers of faces and edges.
MeshFeatures random_mesh(std::size_t faces, std::size_t edges, std::size_t samples, Random& random) {
    MeshFeatures mesh;
    mesh.unary.rows = faces;
    mesh.pairwise.rows = edges;
    add_columns(mesh.unary, k_face_features, "face.", random);
    add_columns(mesh.pairwise, k_edge_features, "edge.", random);
    mesh.context = test_support::random_context(faces, samples, random);
    mesh.edge_context.begin.push_back(0);
    for (std::size_t e = 0; e < edges; ++e) {
        mesh.edges.push_back({static_cast<std::uint32_t>(random.index(faces)), 0});
        mesh.edge_length.push_back(static_cast<float>(random.uniform(0.5, 2)));
        for (std::size_t near = random.index(6); near > 0; --near) {
            mesh.edge_context.edge.push_back(static_cast<std::uint32_t>(random.index(edges)));
            mesh.edge_context.bin.push_back(static_cast<std::uint8_t>(random.index(EdgeNeighborhood::k_bins)));
        }
        mesh.edge_context.begin.push_back(static_cast<std::uint32_t>(mesh.edge_context.edge.size()));
    }
    return mesh;
}

// Stumps on base features, whose values are normal, and on contextual ones, which are at most 1.
CalibratedStumps random_stage(std::size_t base, std::size_t context, std::size_t classes, Random& random) {
    CalibratedStumps stage;
    stage.stumps.class_count = static_cast<std::uint32_t>(classes);
    stage.link = random.uniform() < 0.5 ? Link::softmax : Link::sigmoid;
    stage.scale = 1.5F;
    for (int m = 0; m < 60; ++m) {
        const bool of_context = context > 0 && random.uniform() < 0.5;
        const std::size_t feature = of_context ? base + random.index(context) : random.index(base);
        const double threshold = of_context ? random.uniform(0, 0.1) : random.normal();
        stage.stumps.stumps.push_back({static_cast<std::uint32_t>(feature), static_cast<float>(threshold),
                                       static_cast<float>(random.uniform(-0.5, 0.5)),
                                       static_cast<float>(random.uniform(-0.5, 0.5)),
                                       1 + random.index((1ULL << classes) - 1)});
        for (std::size_t c = 0; c < classes; ++c) {
            const bool shares = stage.stumps.stumps.back().classes >> c & 1;
            stage.stumps.elsewhere.push_back(shares ? 0.0F : static_cast<float>(random.uniform(-0.1, 0.1)));
        }
    }
    return stage;
}

LinearExpert random_expert(std::size_t base, std::size_t context, std::size_t classes, Random& random) {
    LinearExpert expert;
    expert.ratio = 2;
    expert.scale = 1.25F;
    LinearClassifier& linear = expert.classifier;
    linear.class_count = static_cast<std::uint32_t>(classes);
    for (std::size_t f = 0; f < base + context; ++f) {
        const bool of_context = f >= base;
        linear.mean.push_back(of_context ? 0.03F : 0.1F);
        linear.inverse.push_back(f % 7 == 0 ? 0.0F : of_context ? 20.0F : 1.0F);
        for (std::size_t c = 0; c < classes; ++c)
            linear.weight.push_back(static_cast<float>(random.uniform(-0.05, 0.05)));
    }
    for (std::size_t c = 0; c < classes; ++c) linear.constant.push_back(static_cast<float>(random.uniform(0.1, 0.5)));
    return expert;
}

// A model of `stages` classifiers of faces, each with a linear one if `linear`, and of `edge_stages` of edges.
LabelingModel random_cascade(std::size_t classes, std::size_t stages, bool linear, std::size_t edge_stages,
                             Random& random) {
    LabelingModel model;
    for (std::size_t c = 0; c < classes; ++c) model.label_names.push_back("label" + std::to_string(c));
    for (std::size_t f = 0; f < k_face_features; ++f) model.unary_names.push_back("face." + std::to_string(f));
    for (std::size_t f = 0; f < k_edge_features; ++f) model.pairwise_names.push_back("edge." + std::to_string(f));
    const std::size_t context = k_context_measures * k_context_bins * classes;
    for (std::size_t s = 0; s < stages; ++s) {
        model.unary.push_back(random_stage(k_face_features, s > 0 ? context : 0, classes, random));
        if (linear) model.linear.push_back(random_expert(k_face_features, s > 0 ? context : 0, classes, random));
    }
    for (std::size_t s = 0; s < edge_stages; ++s)
        model.pairwise.push_back(random_stage(k_edge_features, s > 0 ? EdgeNeighborhood::k_bins : 0, 2, random));
    return model;
}

struct CascadeParity : testing::Test {
    Profiler profiler;
    GpuStumpScorer scorer{test_support::shared_device()};
    GpuCascade cascade{test_support::shared_device(), scorer, &profiler};
    Random random{5};

    std::vector<MeshFeatures> odd_meshes() {
        std::vector<MeshFeatures> meshes;
        meshes.push_back(random_mesh(1, 0, 1, random));
        meshes.push_back(random_mesh(63, 95, 20, random));
        meshes.push_back(random_mesh(300, 447, 65, random));
        meshes.push_back(random_mesh(17, 16, 17, random));
        return meshes;
    }
    static std::vector<MeshFeatures*> pointers(std::vector<MeshFeatures>& meshes) {
        std::vector<MeshFeatures*> result;
        result.reserve(meshes.size());
        for (MeshFeatures& mesh : meshes) result.push_back(&mesh);
        return result;
    }
};

void expect_near_probabilities(const std::vector<float>& actual, const std::vector<float>& expected,
                               std::size_t classes) {
    ASSERT_EQ(actual.size(), expected.size());
    std::size_t others = 0;
    for (std::size_t first = 0; first < actual.size(); first += classes) {
        float largest = 0, sum = 0;
        for (std::size_t i = first; i < first + classes; ++i) {
            ASSERT_TRUE(std::isfinite(actual[i])) << i;
            largest = std::max(largest, std::abs(actual[i] - expected[i]));
            sum += actual[i];
        }
        if (classes > 1) {
            ASSERT_NEAR(sum, 1, 1e-5F);
        }
        others += largest > k_probability_tolerance ? 1 : 0;
    }
    const std::size_t rows = actual.size() / classes;
    EXPECT_LE(static_cast<double>(others), k_most_other_answers * static_cast<double>(rows));
}

void expect_near_scores(const FaceScores& actual, const FaceScores& expected, std::size_t classes) {
    expect_near_probabilities(actual.probabilities, expected.probabilities, classes);
    expect_near_probabilities(actual.boundary, expected.boundary, 1);
}

std::vector<FaceScores> reference(const LabelingModel& model, std::vector<MeshFeatures> meshes) {
    CpuStumpScorer stumps;
    CpuContextHistograms context;
    std::vector<MeshFeatures*> all;
    all.reserve(meshes.size());
    for (MeshFeatures& mesh : meshes) all.push_back(&mesh);
    return score_faces(model, all, {stumps, context});
}

TEST_F(CascadeParity, StagesClassesAndParts) {
    for (const std::size_t classes : {1U, 2U, 5U, 8U, 33U})
        for (const std::size_t stages : {1U, 2U, 3U})
            for (const bool linear : {false, true})
                for (const bool averages : {false, true}) {
                    SCOPED_TRACE(classes);
                    SCOPED_TRACE(stages);
                    SCOPED_TRACE(linear);
                    SCOPED_TRACE(averages);
                    LabelingModel model = random_cascade(classes, stages, linear, stages, random);
                    if (averages) model.averaged_labels = {static_cast<std::uint32_t>(classes - 1)};
                    std::vector<MeshFeatures> meshes = odd_meshes();
                    const std::vector<FaceScores> expected = reference(model, meshes);
                    const std::vector<FaceScores> actual = cascade.score(model, pointers(meshes));
                    ASSERT_EQ(actual.size(), expected.size());
                    for (std::size_t m = 0; m < meshes.size(); ++m) {
                        SCOPED_TRACE(m);
                        expect_near_scores(actual[m], expected[m], classes);
                        EXPECT_EQ(meshes[m].unary.cols(), k_face_features);  // context stays on the device
                    }
                }
}

TEST_F(CascadeParity, AveragedLabelsOfAllKinds) {
    LabelingModel model = random_cascade(40, 3, true, 1, random);
    std::vector<MeshFeatures> meshes = odd_meshes();
    for (const std::vector<std::uint32_t>& averaged :
         std::vector<std::vector<std::uint32_t>>{{0}, {31, 32}, {3, 39}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}}) {
        model.averaged_labels = averaged;
        const std::vector<FaceScores> expected = reference(model, meshes),
                                      actual = cascade.score(model, pointers(meshes));
        for (std::size_t m = 0; m < meshes.size(); ++m) expect_near_scores(actual[m], expected[m], 40);
    }
}

TEST_F(CascadeParity, MeshesOfAGroupAreScoredAsOneByOne) {
    LabelingModel model = random_cascade(6, 3, true, 2, random);
    model.averaged_labels = {2};
    std::vector<MeshFeatures> meshes = odd_meshes();
    const std::vector<MeshFeatures*> all = pointers(meshes);
    const std::vector<FaceScores> together = cascade.score(model, all);
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        SCOPED_TRACE(m);
        const std::vector<FaceScores> alone = cascade.score(model, std::span(all).subspan(m, 1));
        EXPECT_EQ(alone[0].probabilities, together[m].probabilities);
        EXPECT_EQ(alone[0].boundary, together[m].boundary);
    }
}

TEST_F(CascadeParity, FacesAreOneSubmissionAndEdgesOneMorePerStage) {
    std::vector<MeshFeatures> meshes = odd_meshes();
    const std::vector<MeshFeatures*> all = pointers(meshes);
    for (const std::size_t edge_stages : {0U, 1U, 2U, 3U}) {
        SCOPED_TRACE(edge_stages);
        const LabelingModel model = random_cascade(5, 3, true, edge_stages, random);
        profiler.reset();
        const std::vector<FaceScores> scores = cascade.score(model, all);
        EXPECT_EQ(profiler.submissions(), std::max<std::size_t>(edge_stages, 1));
        ASSERT_EQ(scores[1].seconds.size(), 2U);
        if (edge_stages == 0) {
            EXPECT_EQ(scores[1].boundary, std::vector<float>(meshes[1].edges.size(), k_unknown_boundary_probability));
        }
    }
}

// What does not fit is scored by one classifier after the other.
TEST_F(CascadeParity, LimitsAreKept) {
    const LabelingModel model = random_cascade(5, 2, true, 2, random);
    std::vector<MeshFeatures> meshes;
    for (const std::size_t faces : {100U, 1000U, 120U, 130U}) meshes.push_back(random_mesh(faces, 150, 20, random));
    const std::vector<MeshFeatures*> all = pointers(meshes);
    EXPECT_EQ(cascade.fitting(model, all), 4U);
    const std::size_t bytes = 512 * k_context_axes * k_context_bins * 5 * sizeof(float);
    GpuCascade small(test_support::shared_device(), scorer, nullptr, bytes);
    EXPECT_EQ(small.fitting(model, all), 1U);
    EXPECT_EQ(small.fitting(model, std::span(all).subspan(1)), 0U);
    EXPECT_EQ(small.fitting(model, std::span(all).subspan(2)), 2U);

    const std::vector<FaceScores> expected = reference(model, meshes);
    GpuContextHistograms context(test_support::shared_device());
    const std::vector<FaceScores> actual = score_faces(model, all, {scorer, context, &small});
    ASSERT_EQ(actual.size(), 4U);
    for (std::size_t m = 0; m < meshes.size(); ++m) expect_near_scores(actual[m], expected[m], 5);
}

TEST_F(CascadeParity, RanksAreBytes) {
    LabelingModel model = random_cascade(3, 2, false, 1, random);
    std::vector<MeshFeatures> meshes = odd_meshes();
    const std::vector<MeshFeatures*> all = pointers(meshes);
    const auto add_thresholds = [&](std::size_t stage, std::uint32_t feature, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            model.unary[stage].stumps.stumps.push_back(
                {feature, static_cast<float>(random.normal()), 0.01F, -0.01F, 1});
            model.unary[stage].stumps.elsewhere.insert(model.unary[stage].stumps.elsewhere.end(), 3, 0);
        }
    };
    for (CalibratedStumps& stage : model.unary) {
        std::erase_if(stage.stumps.stumps, [](const Stump& stump) { return stump.feature == 7; });
        stage.stumps.elsewhere.assign(3 * stage.stumps.stumps.size(), 0);
    }
    add_thresholds(0, 7, 200);
    add_thresholds(1, 7, 55);
    ASSERT_EQ(cascade.fitting(model, all), 4U);
    const std::vector<FaceScores> expected = reference(model, meshes), actual = cascade.score(model, all);
    for (std::size_t m = 0; m < meshes.size(); ++m) expect_near_scores(actual[m], expected[m], 3);
    add_thresholds(1, 7, 1);
    EXPECT_EQ(cascade.fitting(model, all), 0U);
}

TEST_F(CascadeParity, ExtremeModels) {
    std::vector<MeshFeatures> meshes = odd_meshes(), without_edges;
    without_edges.push_back(random_mesh(40, 0, 7, random));
    LabelingModel most = random_cascade(64, 2, true, 1, random), all_averaged = random_cascade(3, 2, true, 1, random),
                  no_stumps = random_cascade(4, 3, true, 2, random);
    all_averaged.averaged_labels = {0, 1, 2};
    no_stumps.unary[1].stumps = {4, {}, {}};
    no_stumps.pairwise[0].stumps = {2, {}, {}};
    for (const LabelingModel* model : {&most, &all_averaged, &no_stumps})
        for (std::vector<MeshFeatures>* some : {&meshes, &without_edges}) {
            SCOPED_TRACE(model->class_count());
            const std::vector<FaceScores> expected = reference(*model, *some),
                                          actual = cascade.score(*model, pointers(*some));
            for (std::size_t m = 0; m < some->size(); ++m)
                expect_near_scores(actual[m], expected[m], model->class_count());
        }
}

// A call that throws leaves nothing behind.
TEST_F(CascadeParity, AfterAFailureItGoesOn) {
    const LabelingModel model = random_cascade(4, 2, true, 2, random);
    std::vector<MeshFeatures> meshes = odd_meshes();
    const std::vector<FaceScores> expected = reference(model, meshes);
    std::vector<MeshFeatures> broken = meshes;
    broken[2].context.sample_face[3] = 300;  // no face
    EXPECT_THROW(cascade.score(model, pointers(broken)), UsageError);
    LabelingModel many_thresholds = model;  // seen when the faces are recorded already
    for (int i = 0; i < 300; ++i)
        many_thresholds.pairwise[0].stumps.stumps.push_back({3, 0.01F * static_cast<float>(i), 0.01F, -0.01F, 1});
    many_thresholds.pairwise[0].stumps.elsewhere.assign(2 * many_thresholds.pairwise[0].stumps.stumps.size(), 0);
    EXPECT_THROW(cascade.score(many_thresholds, pointers(meshes)), UsageError);
    profiler.reset();
    const std::vector<FaceScores> actual = cascade.score(model, pointers(meshes));
    EXPECT_EQ(profiler.submissions(), 2U);
    EXPECT_EQ(profiler.entries().at("labeling/prediction.comp").dispatches, 2U);
    for (std::size_t m = 0; m < meshes.size(); ++m) expect_near_scores(actual[m], expected[m], 4);
}

TEST_F(CascadeParity, OtherFeaturesAreRefused) {
    const LabelingModel model = random_cascade(3, 2, false, 1, random);
    std::vector<MeshFeatures> meshes = odd_meshes();
    meshes[2].unary.names[3] = "another";
    GpuContextHistograms context(test_support::shared_device());
    EXPECT_THROW(score_faces(model, pointers(meshes), {scorer, context, &cascade}), ModelError);
}

}  // namespace
}  // namespace exemplar
