#include "host/labeling/inference/mesh_labeling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "host/labeling/training/training.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// A sphere whose upper half is label 1, the rest 0.
LabeledMesh labeled_halves(float height) {
    LabeledMesh sphere{"sphere", {}, shapes::icosphere(4, 1.0F), {}};  // 5120 faces
    for (Vec3& v : sphere.mesh.vertices)
        if (v.z() > 0) v.z() *= height;
    for (const Vec3& center : face_centers(sphere.mesh)) sphere.label.push_back(center.z() > 0 ? 1 : 0);
    return sphere;
}

TEST(MeshLabeling, SimplifiedTrainingMeshesKeepTheirLabels) {
    LabeledCorpus corpus{{"low", "high"}, {labeled_halves(1.0F)}, {}};
    for (std::size_t f = 0; f < 200; ++f) corpus.meshes.front().label[f] = -1;
    const LabeledMesh original = corpus.meshes.front();
    corpus = working_corpus(std::move(corpus), 800);
    const LabeledMesh& mesh = corpus.meshes.front();
    ASSERT_EQ(mesh.label.size(), mesh.mesh.face_count());
    EXPECT_NEAR(static_cast<double>(mesh.mesh.face_count()), 800, 80);
    const std::vector<Vec3> center = face_centers(mesh.mesh);
    std::size_t unlabeled = 0;
    for (std::size_t f = 0; f < center.size(); ++f) {
        unlabeled += mesh.label[f] < 0 ? 1 : 0;
        if (mesh.label[f] >= 0 && std::abs(center[f].z()) > 0.1F) {
            EXPECT_EQ(mesh.label[f], center[f].z() > 0 ? 1 : 0) << center[f].transpose();
        }
    }
    EXPECT_NEAR(static_cast<double>(unlabeled), 800.0 * 200 / 5120, 15) << "what nobody labeled stays unlabeled";
}

TEST(MeshLabeling, LabelsOfASimplifiedMeshComeBackToItsFaces) {
    LabeledCorpus corpus{{"low", "high"}, {labeled_halves(2.0F), labeled_halves(2.2F), labeled_halves(2.4F)}, {}};
    TrainOptions options;
    options.rounds = 20, options.max_stages = 1, options.rows_per_mesh = 400, options.features.samples = 100;
    corpus = working_corpus(std::move(corpus), 1000);
    std::vector<MeshFeatures> features;
    for (const LabeledMesh& mesh : corpus.meshes) features.push_back(compute_features(mesh.mesh, options.features));
    CpuStumpScorer scorer;
    CpuContextHistograms context;
    TrainReport report;
    const LabelingModel model = train_labeling(corpus, features, options, {scorer, context}, report);

    const LabeledMesh unseen = labeled_halves(2.1F);
    const FaceLabeling labeling = label_mesh(model, unseen.mesh, {}, {scorer, context}, 1000);
    ASSERT_EQ(labeling.label.size(), unseen.mesh.face_count());
    EXPECT_EQ(labeling.confidence.size(), unseen.mesh.face_count());
    EXPECT_EQ(labeling.probabilities.size(), 2 * unseen.mesh.face_count());
    EXPECT_EQ(labeling.border.size(), unseen.mesh.face_count());
    EXPECT_EQ(labeling.seconds.front().first, "features");
    const std::vector<Vec3> centers = face_centers(unseen.mesh);
    double at_border = 0, elsewhere = 0, near = 0, far = 0;
    for (std::size_t f = 0; f < labeling.border.size(); ++f) {
        const bool is_near = std::abs(centers[f].z()) < 0.1F;  // the halves meet at z = 0
        (is_near ? at_border : elsewhere) += static_cast<double>(labeling.border[f]);
        (is_near ? near : far) += 1;
    }
    EXPECT_GT(at_border / near, 2 * elsewhere / far);

    // The same in steps, together with a mesh that is not simplified.
    const TriangleMesh small = shapes::icosphere(2, 1.0F);
    WorkingFeatures large = working_features(model.feature_options, unseen.mesh, {}, 1000),
                    other = working_features(model.feature_options, small, {}, 1000);
    const std::array<MeshFeatures*, 2> both{&other.features, &large.features};
    std::vector<FaceScores> scores = score_faces(model, both, {scorer, context});
    const FaceLabeling in_steps = finish_labeling(model, large, std::move(scores[1]));
    EXPECT_EQ(in_steps.label, labeling.label);
    EXPECT_EQ(in_steps.confidence, labeling.confidence);
    EXPECT_EQ(in_steps.probabilities, labeling.probabilities);
    EXPECT_EQ(in_steps.seconds.front().first, "features");
    EXPECT_EQ(finish_labeling(model, other, std::move(scores[0])).label,
              label_mesh(model, small, {}, {scorer, context}, 1000).label);

    std::size_t right = 0;
    for (std::size_t f = 0; f < unseen.label.size(); ++f) right += labeling.label[f] == unseen.label[f] ? 1 : 0;
    EXPECT_GT(static_cast<double>(right), 0.93 * static_cast<double>(unseen.label.size()));
}

}  // namespace
}  // namespace exemplar
