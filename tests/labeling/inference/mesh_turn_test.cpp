#include "host/labeling/inference/mesh_turn.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/labeling/inference/labeler.h"

namespace exemplar {
namespace {

constexpr float k_degrees = 180 / std::numbers::pi_v<float>;

Eigen::Matrix3f random_turn(Random& random) {
    const auto normal = [&] { return static_cast<float>(random.normal()); };
    return Eigen::Quaternionf(normal(), normal(), normal(), normal()).normalized().toRotationMatrix();
}

float angle_of(const Eigen::Matrix3f& turn) {
    return Eigen::AngleAxisf(turn).angle() * k_degrees;
}

TEST(CoarseTurns, AreRotationsOfWhichOneIsNearAny) {
    const std::vector<Eigen::Matrix3f> turns = coarse_turns();
    EXPECT_EQ(turns.front(), Eigen::Matrix3f::Identity());
    for (const Eigen::Matrix3f& turn : turns) {
        EXPECT_LT((turn * turn.transpose() - Eigen::Matrix3f::Identity()).norm(), 1e-5F);
        EXPECT_NEAR(turn.determinant(), 1, 1e-5);
    }
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(turns[i].cwiseAbs().sum(), 3) << "axes to axes";
    Random random(3);
    float farthest = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const Eigen::Matrix3f wanted = random_turn(random);
        float nearest = 180;
        for (const Eigen::Matrix3f& turn : turns) nearest = std::min(nearest, angle_of(turn.transpose() * wanted));
        farthest = std::max(farthest, nearest);
    }
    EXPECT_LT(farthest, 40);
    EXPECT_GT(farthest, 15) << "the test would see if it compared with nothing";
}

/// Faces on a sphere, each with its height, which no rotation changes, as the one feature of its own.
MeshFeatures sphere_of_faces(std::size_t count) {
    Random random(7);
    MeshFeatures features;
    features.unary.rows = count;
    features.unary.add("shape.height");
    features.position.resize(3 * count);
    for (std::size_t f = 0; f < count; ++f) {
        const Eigen::Vector3d at = Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
        for (std::size_t axis = 0; axis < 3; ++axis) features.position[axis * count + f] = static_cast<float>(at[axis]);
        features.unary.column(0)[f] = static_cast<float>(at.z());
    }
    features.context.sample_face.resize(count);
    std::iota(features.context.sample_face.begin(), features.context.sample_face.end(), 0U);
    return features;
}

/// A stage of which each feature speaks for one of two labels, at thresholds near the middle.
CalibratedStumps stage_of(const std::vector<std::uint32_t>& features) {
    CalibratedStumps stage;
    stage.stumps.class_count = 2;
    for (const std::uint32_t feature : features)
        for (const float threshold : {-0.1F, -0.05F, 0.05F, 0.1F}) {
            Stump stump;
            stump.feature = feature, stump.threshold = threshold, stump.classes = 2, stump.above = 1, stump.below = -1;
            stage.stumps.stumps.push_back(stump);
            stage.stumps.elsewhere.insert(stage.stumps.elsewhere.end(), {0.0F, 0.0F});
        }
    stage.link = Link::softmax, stage.scale = 1;
    return stage;
}

/// Knows faces by height (0) and z (3), and without coordinates by height.
LabelingModel upright_model(const std::vector<std::uint32_t>& features = {0, 3}) {
    LabelingModel model;
    model.label_names = {"below", "above"};
    model.unary_names = {"shape.height"};
    for (const std::string& name : orientation_names()) model.unary_names.push_back(name);
    model.unary = {stage_of(features)};
    model.unoriented = stage_of({0});
    return model;
}

void turn_positions(MeshFeatures& features, const Eigen::Matrix3f& turn) {
    const std::size_t count = features.unary.rows;
    for (std::size_t f = 0; f < count; ++f) {
        const Eigen::Vector3f at(features.position[f], features.position[count + f], features.position[2 * count + f]);
        for (std::size_t axis = 0; axis < 3; ++axis) features.position[axis * count + f] = (turn * at)[axis];
    }
}

TEST(MeshTurn, FindsUpHoweverAMeshLies) {
    const LabelingModel model = upright_model();
    ASSERT_TRUE(uses_orientation(model));
    Random random(11);
    for (int trial = 0; trial < 10; ++trial) {
        const Eigen::Matrix3f lies =
            trial == 0 ? Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Eigen::Vector3f::UnitX()).toRotationMatrix()
                       : random_turn(random);
        MeshFeatures features = sphere_of_faces(600);
        turn_positions(features, lies);
        set_orientation(features, 1, Eigen::Matrix3f::Identity());
        const Eigen::Matrix3f found = likeliest_turn(model, features);
        // Turns about the vertical change nothing that the model knows.
        const float off = std::acos(std::clamp((found * lies).row(2).dot(Eigen::RowVector3f::UnitZ()), -1.0F, 1.0F));
        EXPECT_LT(off * k_degrees, 30) << "trial " << trial;
    }
}

TEST(MeshTurn, AMeshOnItsHeadIsTurnedThoughItLooksAsSure) {
    const LabelingModel model = upright_model({3});
    const Eigen::Matrix3f lies =
        Eigen::AngleAxisf(std::numbers::pi_v<float>, Eigen::Vector3f::UnitX()).toRotationMatrix();
    MeshFeatures features = sphere_of_faces(600);
    turn_positions(features, lies);
    set_orientation(features, 1, Eigen::Matrix3f::Identity());
    EXPECT_GT((likeliest_turn(model, features) * lies)(2, 2), 0.9F);
}

TEST(MeshTurn, AMeshThatLiesWellStays) {
    const LabelingModel model = upright_model();
    for (const float degrees : {0.0F, 3.0F}) {
        MeshFeatures features = sphere_of_faces(600);
        turn_positions(features, Eigen::AngleAxisf(degrees / k_degrees, Eigen::Vector3f::UnitX()).toRotationMatrix());
        set_orientation(features, 1, Eigen::Matrix3f::Identity());
        EXPECT_EQ(likeliest_turn(model, features), Eigen::Matrix3f::Identity());
    }
}

TEST(MeshTurn, AMeshThatLiesOtherwiseIsLabeledAsIfItDidNot) {
    const LabelingModel model = upright_model();
    MeshFeatures features = sphere_of_faces(600);
    features.face_area.assign(600, 1);
    turn_positions(features,
                   Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Eigen::Vector3f::UnitX()).toRotationMatrix());
    CpuStumpScorer scorer;
    CpuContextHistograms context;
    MeshFeatures* const mesh = &features;
    for (int again = 0; again < 2; ++again) {
        const FaceScores scores = score_faces(model, std::span(&mesh, 1), {scorer, context}).front();
        EXPECT_GT(scores.turned, 60);
        std::size_t right = 0;
        for (std::size_t f = 0; f < 600; ++f)
            right += (scores.probabilities[2 * f + 1] > 0.5F) == (features.unary.column(0)[f] > 0) ? 1 : 0;
        EXPECT_GT(right, 570U);
    }
}

TEST(SetOrientation, WritesTurnedCoordinatesInPlaceOfWhatFollows) {
    MeshFeatures features;
    features.unary.rows = 2;
    features.unary.add("shape.a")[1] = 5;
    features.unary.add("context.b");
    features.position = {1, 2, 3, 4, 5, 6};  // faces at (1, 3, 5) and (2, 4, 6)
    const Eigen::Matrix3f turn =
        Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Eigen::Vector3f::UnitZ()).toRotationMatrix();
    for (int again = 0; again < 2; ++again) {
        set_orientation(features, 1, turn);
        EXPECT_THAT(features.unary.names,
                    testing::ElementsAre("shape.a", "orientation.x", "orientation.y", "orientation.z"));
        const std::vector<float> expected{0, 5, -3, -4, 1, 2, 5, 6};
        ASSERT_EQ(features.unary.values.size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(features.unary.values[i], expected[i], 1e-6) << i;
    }
}

TEST(SetOrientation, NeedsPositions) {
    MeshFeatures features;
    features.unary.rows = 2;
    EXPECT_THROW(set_orientation(features, 0, Eigen::Matrix3f::Identity()), ModelError);
}

}  // namespace
}  // namespace exemplar
