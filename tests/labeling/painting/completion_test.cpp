#include "host/labeling/painting/completion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/labeling/painting/mesh_completion.h"
#include "host/labeling/painting/simulated_person.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// Two balls of radius 1 that overlap: a concave edge runs around the plane x = 0. Label 0 is on the left.
struct TwoBalls {
    TriangleMesh mesh = shapes::icosphere(4, 1.0F);
    std::vector<std::int32_t> truth;
    TwoBalls() {
        // A peanut: the radius depends on the angle from the x axis.
        for (Vec3& v : mesh.vertices) v *= 0.35F + 0.65F * std::abs(v.x());
        for (const Vec3& center : face_centers(mesh)) truth.push_back(center.x() > 0 ? 1 : 0);
    }
    std::uint32_t face_nearest(const Vec3& place) const {
        const std::vector<Vec3> center = face_centers(mesh);
        return static_cast<std::uint32_t>(
            std::ranges::min_element(center, {}, [&](const Vec3& c) { return (c - place).norm(); }) - center.begin());
    }
};

std::vector<std::int32_t> painted_at(const TwoBalls& balls,
                                     std::initializer_list<std::pair<Vec3, std::int32_t>> spots) {
    std::vector<std::int32_t> painted(balls.mesh.face_count(), -1);
    for (const auto& [place, label] : spots) painted[balls.face_nearest(place)] = label;
    return painted;
}

/// Descriptors of which both tips are alike, and unlike the middle.
FaceDescriptors tips_and_middle(const TwoBalls& balls) {
    FaceDescriptors descriptors{1, {}};
    for (const Vec3& center : face_centers(balls.mesh))
        descriptors.values.push_back(std::abs(center.x()) > 0.5F ? 2.0F : 0.0F);
    return descriptors;
}

double share_right(const std::vector<std::int32_t>& label, const std::vector<std::int32_t>& truth) {
    std::size_t right = 0;
    for (std::size_t f = 0; f < label.size(); ++f) right += label[f] == truth[f] ? 1 : 0;
    return static_cast<double>(right) / static_cast<double>(label.size());
}

TEST(LabelCompletion, NothingPaintedStaysWithoutLabels) {
    const TwoBalls balls;
    const LabelCompletion completion(balls.mesh);
    const CompletedLabels completed = completion.complete(std::vector<std::int32_t>(balls.truth.size(), -1), 3);
    EXPECT_EQ(std::ranges::count(completed.label, -1), static_cast<std::ptrdiff_t>(balls.truth.size()));
}

TEST(LabelCompletion, OneSpotOnEachSideMeetsAtTheConcaveWaist) {
    const TwoBalls balls;
    const LabelCompletion completion(balls.mesh);
    // The right spot is much nearer to the waist than the left one.
    const auto painted = painted_at(balls, {{{-1, 0, 0}, 0}, {{0.25F, 0.3F, 0}, 1}});
    const CompletedLabels completed = completion.complete(painted, 2);
    EXPECT_GT(share_right(completed.label, balls.truth), 0.98);
}

TEST(LabelCompletion, PaintedFacesKeepTheirLabels) {
    const TwoBalls balls;
    const LabelCompletion completion(balls.mesh);
    // A lone spot amid the other label costs a border, and stays all the same.
    const auto painted = painted_at(balls, {{{-1, 0, 0}, 0}, {{1, 0, 0}, 1}, {{0.7F, 0.5F, 0}, 0}});
    const CompletedLabels completed = completion.complete(painted, 2);
    for (std::size_t f = 0; f < painted.size(); ++f) {
        if (painted[f] < 0) continue;
        EXPECT_EQ(completed.label[f], painted[f]);
        EXPECT_EQ(completed.confidence[f], 1);
    }
}

TEST(LabelCompletion, ConfidenceIsAProbability) {
    const TwoBalls balls;
    const LabelCompletion completion(balls.mesh);
    const CompletedLabels completed = completion.complete(painted_at(balls, {{{-1, 0, 0}, 0}, {{1, 0, 0}, 2}}), 3);
    for (std::size_t f = 0; f < completed.label.size(); ++f) {
        EXPECT_GE(completed.confidence[f], 0);
        EXPECT_LE(completed.confidence[f], 1);
        EXPECT_NE(completed.label[f], 1) << "nobody painted it";
    }
}

TEST(LabelCompletion, LikenessReachesWhatIsFar) {
    const TwoBalls balls;
    LabelCompletion completion(balls.mesh, {.lambda = 0.01});  // the border around the middle is long
    completion.set_descriptors(tips_and_middle(balls));
    const CompletedLabels completed = completion.complete(painted_at(balls, {{{-1, 0, 0}, 0}, {{0, 0.3F, 0}, 1}}), 2);
    EXPECT_EQ(completed.label[balls.face_nearest({1, 0, 0})], 0) << "the other tip";
    EXPECT_EQ(completed.label[balls.face_nearest({0, -0.3F, 0})], 1);
}

/// A model that says label 0 everywhere, and rates label 1 low.
LabelEvidence evidence_for_label_0(const TwoBalls& balls) {
    LabelEvidence evidence;
    for (std::size_t f = 0; f < balls.truth.size(); ++f)
        evidence.probabilities.insert(evidence.probabilities.end(), {0.95F, 0.05F});
    const Topology topology = build_topology(balls.mesh);
    for (const Edge& edge : topology.edges) {
        evidence.edges.push_back(edge.face);
        evidence.edge_cost.push_back(1e-4);
    }
    evidence.compatibility = {0, 1, 1, 0};
    return evidence;
}

TEST(LabelCompletion, AStrokeCorrectsWhatAModelSaysAroundIt) {
    const TwoBalls balls;
    LabelCompletion completion(balls.mesh);
    const CompletedLabels none = completion.complete(painted_at(balls, {{{1, 0, 0}, 1}}), 2);
    EXPECT_EQ(std::ranges::count(none.label, 1), static_cast<std::ptrdiff_t>(balls.truth.size())) << "no model yet";
    completion.set_evidence(evidence_for_label_0(balls));
    const CompletedLabels completed = completion.complete(painted_at(balls, {{{1, 0, 0}, 1}}), 2);
    EXPECT_EQ(completed.label[balls.face_nearest({0.9F, 0.2F, 0})], 1) << "near the stroke";
    EXPECT_EQ(completed.label[balls.face_nearest({-1, 0, 0})], 0) << "far from it";

    // A label that the palette gained after the model was trained.
    const CompletedLabels grown = completion.complete(painted_at(balls, {{{1, 0, 0}, 2}}), 3);
    EXPECT_EQ(grown.label[balls.face_nearest({0.9F, 0.2F, 0})], 2);
    EXPECT_EQ(grown.label[balls.face_nearest({-1, 0, 0})], 0);
}

TEST(LabelCompletion, AStrokeCorrectsAModelWhereverTheSurfaceIsAlike) {
    const TwoBalls balls;
    LabelCompletion completion(balls.mesh);
    completion.set_evidence(evidence_for_label_0(balls));
    completion.set_descriptors(tips_and_middle(balls));
    const CompletedLabels completed = completion.complete(painted_at(balls, {{{1, 0, 0}, 1}}), 2);
    EXPECT_EQ(completed.label[balls.face_nearest({-1, 0, 0})], 1) << "the other tip";
    EXPECT_EQ(completed.label[balls.face_nearest({0, 0.3F, 0})], 0) << "what is unlike stays as the model says";

    // Both tips are like both strokes. Each tip takes the label of the nearer stroke.
    const CompletedLabels told = completion.complete(painted_at(balls, {{{1, 0, 0}, 1}, {{-1, 0, 0}, 0}}), 2);
    EXPECT_EQ(told.label[balls.face_nearest({0.9F, 0.2F, 0})], 1);
    EXPECT_EQ(told.label[balls.face_nearest({-0.9F, 0.2F, 0})], 0);
}

TEST(LabelCompletion, ALargeMeshIsCompletedOnASmallerOne) {
    const TwoBalls balls;
    const MeshCompletion completion(balls.mesh, 1000);
    const auto painted = painted_at(balls, {{{-1, 0, 0}, 0}, {{1, 0, 0}, 1}});
    const CompletedLabels completed = completion.complete(painted, 2);
    ASSERT_EQ(completed.label.size(), balls.truth.size());
    EXPECT_GT(share_right(completed.label, balls.truth), 0.95);
    for (std::size_t f = 0; f < painted.size(); ++f)
        if (painted[f] >= 0) {
            EXPECT_EQ(completed.label[f], painted[f]);
        }
}

TEST(FaceDescriptors, AreAlikeOnAShapeThatIsMovedTurnedAndScaled) {
    TwoBalls balls;
    const FaceDescriptors before = face_descriptors(compute_features(balls.mesh, {.samples = 100}));
    for (Vec3& v : balls.mesh.vertices) v = 3 * Vec3(-v.y(), v.x(), v.z()) + Vec3(5, 6, 7);
    const FaceDescriptors after = face_descriptors(compute_features(balls.mesh, {.samples = 100}));
    // Components may change their signs; distances do not.
    const auto distance = [](const FaceDescriptors& d, std::size_t a, std::size_t b) {
        float sum = 0;
        for (std::size_t i = 0; i < d.dimensions; ++i)
            sum += std::pow(d.values[a * d.dimensions + i] - d.values[b * d.dimensions + i], 2.0F);
        return std::sqrt(sum);
    };
    float mean = 0;
    for (std::size_t a = 0; a < 4000; a += 97) {
        EXPECT_NEAR(distance(before, a, a + 1000), distance(after, a, a + 1000), 0.15F) << a;
        mean += distance(before, a, a + 1000) / 42;
    }
    EXPECT_NEAR(mean, 1, 0.5F) << "the mean squared distance is 1";
}

TEST(SimulatedPerson, PaintsTheMiddleOfTheLargestWrongRegion) {
    const TwoBalls balls;
    const SimulatedPerson person(balls.mesh, balls.truth);
    std::vector<std::int32_t> shown = balls.truth;
    EXPECT_FALSE(person.next_stroke(shown));
    EXPECT_EQ(person.right(shown), 1);
    for (std::size_t f = 0; f < shown.size(); ++f)
        if (shown[f] == 1) shown[f] = 0;
    EXPECT_NEAR(person.right(shown), 0.5, 0.01);
    const auto stroke = person.next_stroke(shown);
    ASSERT_TRUE(stroke);
    EXPECT_EQ(stroke->label, 1);
    ASSERT_FALSE(stroke->faces.empty());
    const std::vector<Vec3> center = face_centers(balls.mesh);
    float mean = 0;
    for (const std::uint32_t face : stroke->faces) {
        EXPECT_EQ(balls.truth[face], 1) << "the person does not paint over the border";
        mean += center[face].x() / static_cast<float>(stroke->faces.size());
    }
    EXPECT_GT(mean, 0.6F) << "far from the waist";
    EXPECT_LT(stroke->faces.size(), balls.truth.size() / 8);
}

}  // namespace
}  // namespace exemplar
