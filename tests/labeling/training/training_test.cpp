// Training end to end, on generated shapes with the real features.

#include "host/labeling/training/training.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <thread>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/labeling/evaluation/evaluation.h"
#include "host/labeling/inference/mesh_turn.h"
#include "host/synth/shapes/shapes.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

LabeledCorpus generated(const std::string& kind, std::uint64_t first_seed, std::size_t count, std::size_t faces) {
    LabeledCorpus corpus;
    for (std::size_t i = 0; i < count; ++i) {
        SynthShape shape = make_shape(kind, first_seed + i, faces);
        corpus.names = shape.labels.names;
        corpus.meshes.push_back({kind + std::to_string(i), {}, std::move(shape.mesh), std::move(shape.labels.label)});
    }
    return corpus;
}

std::vector<MeshFeatures> features_of(const LabeledCorpus& corpus, const FeatureOptions& options) {
    std::vector<MeshFeatures> features;
    for (const LabeledMesh& mesh : corpus.meshes) features.push_back(compute_features(mesh.mesh, options));
    return features;
}

TrainOptions quick_options() {
    TrainOptions options;
    options.rounds = 30, options.patience = 10, options.max_stages = 2, options.rows_per_mesh = 400;
    options.features.samples = 150;
    return options;
}

class SlowTraining : public testing::Test {
  protected:
    LabelingModel train(const LabeledCorpus& corpus, const TrainOptions& options) {
        std::vector<MeshFeatures> features = features_of(corpus, options.features);
        return train_labeling(corpus, features, options, {scorer_, context_}, report_);
    }
    CpuStumpScorer scorer_;
    CpuContextHistograms context_;
    TrainReport report_;
};

TEST_F(SlowTraining, LabelsUnseenShapes) {
    const LabeledCorpus corpus = generated("human", 1, 5, 2000);
    TrainOptions options = quick_options();
    options.rounds = 80;
    const LabelingModel model = train(corpus, options);
    EXPECT_LT(report_.crf.error, report_.crf.error_without_cut) << "the cut helps on the training meshes, out of fold";

    const LabeledCorpus unseen = generated("human", 100, 3, 2000);
    double rate = 0;
    for (const LabeledMesh& mesh : unseen.meshes) {
        MeshFeatures features = compute_features(mesh.mesh, options.features);
        const FaceLabeling labeling = label_faces(model, features, {scorer_, context_});
        rate +=
            score_labeling(features.face_area, mesh.label, labeling.label, model.class_count()).recognition_rate / 3;
    }
    EXPECT_GT(rate, 0.85) << "stated accuracy on generated humans";
}

TEST_F(SlowTraining, EqualSeedsGiveEqualBytesForAnyThreadCount) {
    const LabeledCorpus corpus = generated("cup", 1, 3, 1000);
    const fs::path folder = testing::TempDir();
    std::vector<std::string> bytes;
    for (const std::size_t threads : {1UL, 2UL, 3UL}) {
        const ThreadLimit limit(threads);
        const fs::path path = folder / ("exemplar_same_seed_" + std::to_string(threads) + ".safetensors");
        save_model(path, train(corpus, quick_options()));
        bytes.push_back(read_file(path));
    }
    EXPECT_EQ(bytes[0], bytes[1]);
    EXPECT_EQ(bytes[0], bytes[2]);
}

TEST_F(SlowTraining, OneOrTwoMeshesAreEnoughToTrain) {
    for (const std::size_t meshes : {1UL, 2UL}) {
        const LabeledCorpus corpus = generated("cup", 1, meshes, 1000);
        const LabelingModel model = train(corpus, quick_options());
        EXPECT_EQ(report_.folds.size(), meshes == 1 ? 5U : 2U);
        MeshFeatures features = compute_features(corpus.meshes[0].mesh, model.feature_options);
        const FaceLabeling labeling = label_faces(model, features, {scorer_, context_});
        EXPECT_GT(score_labeling(features.face_area, corpus.meshes[0].label, labeling.label, 2).recognition_rate, 0.9);
    }
}

TEST_F(SlowTraining, LabelsMissingFromSomeMeshesAndUnlabeledFacesAreFine) {
    LabeledCorpus corpus = generated("cup", 1, 3, 1000);
    for (std::int32_t& label : corpus.meshes[0].label)
        if (label == 1) label = 0;
    for (std::size_t f = 0; f < corpus.meshes[1].label.size(); f += 3) corpus.meshes[1].label[f] = -1;
    EXPECT_NO_THROW(train(corpus, quick_options()));
}

TEST_F(SlowTraining, ForALabelOfOneMeshAllStagesCount) {
    LabeledCorpus corpus = generated("cup", 1, 3, 1000);
    for (const std::size_t m : {1UL, 2UL})
        for (std::int32_t& label : corpus.meshes[m].label) label = 0;  // body
    const LabelingModel model = train(corpus, quick_options());
    ASSERT_EQ(model.unary.size(), 2U);
    EXPECT_EQ(model.averaged_labels, std::vector<std::uint32_t>{1});
    MeshFeatures features = compute_features(corpus.meshes[0].mesh, model.feature_options);
    MeshFeatures* const mesh = &features;
    const auto handle = [&](const LabelingModel& of) {
        const std::vector<float> probabilities =
            score_faces(of, std::span(&mesh, 1), {scorer_, context_}).front().probabilities;
        std::vector<float> result;
        for (std::size_t f = 0; f < features.face_area.size(); ++f) {
            EXPECT_NEAR(probabilities[2 * f] + probabilities[2 * f + 1], 1, 1e-5) << "face " << f;
            result.push_back(probabilities[2 * f + 1]);
        }
        return result;
    };
    const std::vector<float> both = handle(model);
    LabelingModel part = model;
    part.averaged_labels.clear();
    const std::vector<float> second = handle(part);
    part.unary.pop_back();
    const std::vector<float> first = handle(part);
    for (std::size_t f = 0; f < both.size(); ++f) ASSERT_NEAR(both[f], (first[f] + second[f]) / 2, 1e-5) << f;
    EXPECT_NE(first, second);
}

TEST_F(SlowTraining, PartsInSeparatePiecesHaveNoBoundaries) {
    LabeledCorpus corpus;
    corpus.names = {"ball", "box"};
    for (const float size : {1.0F, 1.2F, 1.4F}) {
        TriangleMesh mesh = shapes::icosphere(2, size);
        const auto offset = static_cast<std::uint32_t>(mesh.vertex_count());
        const TriangleMesh box = shapes::translated(shapes::box(1, size, 1, 4), Vec3(4, 0, 0));
        std::vector<std::int32_t> label(mesh.face_count(), 0);
        mesh.vertices.insert(mesh.vertices.end(), box.vertices.begin(), box.vertices.end());
        for (const Face& face : box.faces) mesh.faces.push_back({face[0] + offset, face[1] + offset, face[2] + offset});
        mesh.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
        label.resize(mesh.face_count(), 1);
        corpus.meshes.push_back({"piece", {}, std::move(mesh), std::move(label)});
    }
    const LabelingModel model = train(corpus, quick_options());
    EXPECT_TRUE(model.pairwise.empty());
    MeshFeatures features = compute_features(corpus.meshes[1].mesh, model.feature_options);
    EXPECT_EQ(label_faces(model, features, {scorer_, context_}).label, corpus.meshes[1].label);
}

/// Counts what a device would be asked.
class CountingBackend {
  public:
    LabelingBackend labeling() { return {scorer_, context_}; }
    std::size_t scored() const { return scorer_.calls; }
    std::size_t contexts() const { return context_.calls; }

  private:
    struct Scorer final : StumpScorer {
        std::size_t calls = 0;
        CpuStumpScorer cpu;
        void probabilities_of_all(const BoostedStumps& classifier, Link link, float scale,
                                  std::span<const ScoredMatrix> matrices) override {
            ++calls;
            cpu.probabilities_of_all(classifier, link, scale, matrices);
        }
    };
    struct Context final : ContextHistograms {
        std::size_t calls = 0;
        CpuContextHistograms cpu;
        void accumulate_all(std::span<const ContextMesh> meshes, std::size_t classes) override {
            ++calls;
            cpu.accumulate_all(meshes, classes);
        }
    };
    Scorer scorer_;
    Context context_;
};

TEST_F(SlowTraining, ManyMeshesAreScoredTogetherAndCutOnThreadsAsOneByOne) {
    TrainOptions options = quick_options();
    options.orientation = OrientationUse::never;
    const LabelingModel model = train(generated("human", 1, 3, 1000), options);
    ASSERT_EQ(model.unary.size(), 2U);
    ASSERT_FALSE(model.pairwise.empty());
    std::vector<MeshFeatures> features;
    for (const std::size_t faces : {700UL, 1500UL, 1001UL, 2000UL})
        features.push_back(compute_features(make_shape("human", 90 + faces, faces).mesh, model.feature_options));
    std::vector<FaceLabeling> alone;
    alone.reserve(features.size());
    for (MeshFeatures mesh : features) alone.push_back(label_faces(model, mesh, {scorer_, context_}));

    CountingBackend counting;
    std::vector<MeshFeatures*> meshes;
    meshes.reserve(features.size());
    for (MeshFeatures& mesh : features) meshes.push_back(&mesh);
    std::vector<FaceScores> scores = score_faces(model, meshes, counting.labeling());
    ASSERT_EQ(scores.size(), 4U);
    EXPECT_EQ(counting.scored(), model.unary.size() + model.pairwise.size());
    EXPECT_EQ(counting.contexts(), 1U);
    std::vector<FaceLabeling> together(4);
    const auto cut = [&](std::size_t first) {
        for (std::size_t m = first; m < 4; m += 2) together[m] = cut_faces(model, features[m], scores[m]);
    };
    std::thread even(cut, 0), odd(cut, 1);
    even.join(), odd.join();
    for (std::size_t m = 0; m < 4; ++m) {
        SCOPED_TRACE(m);
        EXPECT_EQ(together[m].label, alone[m].label);
        EXPECT_EQ(together[m].probabilities, alone[m].probabilities);
        EXPECT_EQ(together[m].confidence, alone[m].confidence);
        ASSERT_EQ(together[m].seconds.size(), 3U);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ(together[m].seconds[i].first, (std::array{"unary", "pairwise", "cut"})[i]);
    }
    EXPECT_TRUE(score_faces(model, {}, counting.labeling()).empty());
}

/// Balls that nothing but the direction up divides, squeezed a little in each direction, each turned by `turn(i)`.
template <typename Turn>
LabeledCorpus divided_balls(std::size_t count, const Turn& turn) {
    LabeledCorpus corpus;
    corpus.names = {"lower", "upper"};
    Random random(5);
    for (std::size_t i = 0; i < count; ++i) {
        TriangleMesh mesh = shapes::icosphere(3, 1);
        std::vector<std::int32_t> label;
        for (const Face& face : mesh.faces)
            label.push_back(mesh.vertices[face[0]].z() + mesh.vertices[face[1]].z() + mesh.vertices[face[2]].z() > 0);
        Vec3 squeeze;
        for (int axis = 0; axis < 3; ++axis) squeeze[axis] = static_cast<float>(random.uniform(0.8, 1.2));
        const Eigen::Matrix3f turned = turn(i);
        for (Vec3& vertex : mesh.vertices) vertex = turned * vertex.cwiseProduct(squeeze);
        corpus.meshes.push_back({"ball" + std::to_string(i), {}, std::move(mesh), std::move(label)});
    }
    return corpus;
}

Eigen::Matrix3f untouched(std::size_t) {
    return Eigen::Matrix3f::Identity();
}

TEST_F(SlowTraining, MeshesThatLieAlikeAreKnownByWhereTheirFacesAre) {
    const LabeledCorpus corpus = divided_balls(5, untouched);
    const LabelingModel model = train(corpus, quick_options());
    EXPECT_TRUE(uses_orientation(model));
    ASSERT_GT(report_.stages.size(), 1U);
    EXPECT_FALSE(report_.stages[0].kept);
    EXPECT_TRUE(report_.stages[1].kept);
    const LabeledMesh unseen = divided_balls(7, untouched).meshes.back();
    MeshFeatures features = compute_features(unseen.mesh, model.feature_options);
    const FaceLabeling labeling = label_faces(model, features, {scorer_, context_});
    EXPECT_EQ(labeling.turned, 0);
    EXPECT_GT(score_labeling(features.face_area, unseen.label, labeling.label, 2).recognition_rate, 0.9);

    const fs::path path = fs::path(testing::TempDir()) / "exemplar_oriented.safetensors";
    save_model(path, model);
    EXPECT_EQ(label_faces(load_model(path), features, {scorer_, context_}).label, labeling.label);
}

TEST_F(SlowTraining, MeshesThatLieAnyhowAreNot) {
    const auto anyhow = [](std::size_t i) {
        return Eigen::AngleAxisf(static_cast<float>(i), Eigen::Vector3f(1, 0.3F, 0.1F).normalized()).toRotationMatrix();
    };
    const LabeledCorpus corpus = divided_balls(5, anyhow);
    EXPECT_FALSE(uses_orientation(train(corpus, quick_options())));
    ASSERT_GT(report_.stages.size(), 1U);
    EXPECT_TRUE(report_.stages[0].kept);
    EXPECT_FALSE(report_.stages[1].kept);
}

/// Counts how often the features of each mesh are loaded.
struct CountedLoads {
    std::vector<MeshFeatures> features;
    std::vector<int> loads = std::vector<int>(features.size(), 0);
    bool are_stored = true;

    TrainingFeatures training_features(std::size_t bytes) {
        const auto load = [this](std::size_t mesh) {
            ++loads[mesh];
            return features[mesh];
        };
        return {features.size(), {load, [this](std::size_t) { return are_stored; }}, bytes, [](std::size_t) {}};
    }
};

TEST_F(SlowTraining, TheModelDoesNotDependOnHowManyFeaturesStayInMemory) {
    const auto anyhow = [](std::size_t i) {
        return Eigen::AngleAxisf(static_cast<float>(i), Eigen::Vector3f(1, 0.3F, 0.1F).normalized()).toRotationMatrix();
    };
    const fs::path path = fs::path(testing::TempDir()) / "exemplar_kept.safetensors";
    const TrainOptions options = quick_options();
    // With coordinates; with coordinates that are tried and left out; one mesh, cut into patches.
    for (const LabeledCorpus& corpus :
         {divided_balls(3, untouched), divided_balls(3, anyhow), divided_balls(1, untouched)}) {
        save_model(path, train(corpus, options));
        const std::string expected = read_file(path);
        const std::vector<MeshFeatures> features = features_of(corpus, options.features);
        const std::size_t one = feature_bytes(features[0]), count = features.size();
        for (const std::size_t bytes : {std::size_t{0}, one + one / 2, 100 * one}) {
            CountedLoads counted{features};
            TrainingFeatures some = counted.training_features(bytes);
            for (int again = 0; again < 2; ++again) {
                save_model(path, train_labeling(corpus, some, options, {scorer_, context_}, report_));
                EXPECT_EQ(read_file(path), expected) << bytes;
            }
            EXPECT_EQ(counted.loads.front() > 1, bytes == 0) << bytes;
            if (count > 1) {
                EXPECT_EQ(counted.loads.back() > 1, bytes < 100 * one) << bytes;
            }
        }
    }
}

TEST_F(SlowTraining, FeaturesThatAreNotStoredStayInMemory) {
    const LabeledCorpus corpus = divided_balls(2, untouched);
    CountedLoads counted{features_of(corpus, quick_options().features)};
    counted.are_stored = false;
    TrainingFeatures all = counted.training_features(0);
    train_labeling(corpus, all, quick_options(), {scorer_, context_}, report_);
    EXPECT_EQ(counted.loads, (std::vector<int>{1, 1}));
}

TEST_F(SlowTraining, OrientationIsUsedOrNotAsTheUserAsks) {
    const LabeledCorpus corpus = divided_balls(3, untouched);
    TrainOptions options = quick_options();
    options.max_stages = 1;
    for (const auto& [name, used] : {std::pair{"yes", true}, std::pair{"no", false}}) {
        options.orientation = orientation_use(name);
        EXPECT_EQ(uses_orientation(train(corpus, options)), used) << name;
        EXPECT_EQ(report_.stages.front().kept, !used);
    }
    EXPECT_THROW(orientation_use("perhaps"), UsageError);
    options.orientation = OrientationUse::automatic;
    const LabeledCorpus two = divided_balls(2, untouched);
    EXPECT_FALSE(uses_orientation(train(two, options))) << "two meshes do not tell whether all lie alike";
}

TEST_F(SlowTraining, AModelRefusesOtherFeatures) {
    const LabeledCorpus corpus = generated("cup", 1, 2, 1000);
    const LabelingModel model = train(corpus, quick_options());
    FeatureOptions other = model.feature_options;
    MeshFeatures features = compute_features(corpus.meshes[0].mesh, other);
    features.unary.names[3] = "another.feature";
    EXPECT_THROW(label_faces(model, features, {scorer_, context_}), ModelError);
    MeshFeatures good = compute_features(corpus.meshes[1].mesh, other);
    const std::array<MeshFeatures*, 2> both{&good, &features};
    EXPECT_THROW(score_faces(model, both, {scorer_, context_}), ModelError);
}

TEST(Training, NothingToLearnFromIsAnError) {
    CpuStumpScorer scorer;
    CpuContextHistograms context;
    TrainReport report;
    std::vector<MeshFeatures> none;
    EXPECT_THROW(train_labeling({}, none, {}, {scorer, context}, report), DataError);
    LabeledCorpus one_label;
    one_label.names = {"all"};
    one_label.meshes.resize(1);
    std::vector<MeshFeatures> features(1);
    EXPECT_THROW(train_labeling(one_label, features, {}, {scorer, context}, report), DataError);
}

TEST(Splits, AreSeededDisjointAndComplete) {
    const std::vector<Split> splits = make_splits(20, 6, 3, 7);
    ASSERT_EQ(splits.size(), 3U);
    EXPECT_NE(splits[0].train, splits[1].train);
    EXPECT_EQ(splits[0].train, make_splits(20, 6, 1, 7)[0].train);
    for (const Split& split : splits) {
        EXPECT_EQ(split.train.size(), 6U);
        std::vector<std::size_t> all = split.train;
        all.insert(all.end(), split.test.begin(), split.test.end());
        std::sort(all.begin(), all.end());
        for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(all[i], i);
    }
    const std::vector<Split> leave_one_out = make_splits(4, 3, 4, 1);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_THAT(leave_one_out[k].test, testing::ElementsAre(k));
    EXPECT_THROW(make_splits(4, 4, 1, 1), UsageError);
    EXPECT_THROW(make_splits(4, 0, 1, 1), UsageError);
}

}  // namespace
}  // namespace exemplar
