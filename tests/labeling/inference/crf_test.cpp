#include "host/labeling/inference/crf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/labeling/features/edge_context.h"
#include "host/labeling/inference/labeler.h"
#include "host/labeling/training/crf_learning.h"

namespace exemplar {
namespace {

using testing::ElementsAre;

/// A strip of faces of area 1 whose neighbors share edges of length 1; the dihedral angle is flat except where said.
MeshFeatures strip_of_faces(std::size_t faces) {
    MeshFeatures features;
    features.face_area.assign(faces, 1);
    for (std::uint32_t f = 0; f + 1 < faces; ++f) features.edges.push_back({f, f + 1});
    features.edge_length.assign(features.edges.size(), 1);
    features.dihedral.assign(features.edges.size(), 1);
    return features;
}

CrfParameters potts(double mu, std::size_t classes) {
    CrfParameters parameters;
    parameters.kappa = 1e-9, parameters.lambda = 1e-9, parameters.mu = mu;
    parameters.compatibility.assign(classes * classes, 1);
    for (std::size_t c = 0; c < classes; ++c) parameters.compatibility[c * classes + c] = 0;
    parameters.merge_fraction = 0;
    return parameters;
}

TEST(Crf, SmoothsAWeakDissenterAndKeepsAStrongOne) {
    const MeshFeatures features = strip_of_faces(5);
    const std::vector<float> boundary(4, 0.5F);
    const std::vector<float> weak{0.9F, 0.1F, 0.9F, 0.1F, 0.4F, 0.6F, 0.9F, 0.1F, 0.9F, 0.1F};
    EXPECT_THAT(solve_crf(features, make_crf_terms(features, weak, 2, boundary), potts(1, 2)),
                ElementsAre(0, 0, 0, 0, 0));
    std::vector<float> strong = weak;
    strong[4] = 0.01F, strong[5] = 0.99F;
    EXPECT_THAT(solve_crf(features, make_crf_terms(features, strong, 2, boundary), potts(1, 2)),
                ElementsAre(0, 0, 1, 0, 0));
}

TEST(Crf, CutsWhereTheEdgeIsConcaveOrTheClassifierSaysSo) {
    MeshFeatures features = strip_of_faces(6);
    const std::vector<float> probabilities{0.9F, 0.1F, 0.6F, 0.4F, 0.5F, 0.5F, 0.5F, 0.5F, 0.4F, 0.6F, 0.1F, 0.9F};
    CrfParameters parameters = potts(0.01, 2);
    parameters.lambda = 1;
    features.dihedral[1] = 0.4F;
    EXPECT_THAT(
        solve_crf(features, make_crf_terms(features, probabilities, 2, std::vector<float>(5, 0.5F)), parameters),
        ElementsAre(0, 0, 1, 1, 1, 1));
    parameters.lambda = 1e-9, parameters.kappa = 1;
    std::vector<float> boundary(5, 0.01F);
    boundary[3] = 0.99F;
    EXPECT_THAT(solve_crf(features, make_crf_terms(features, probabilities, 2, boundary), parameters),
                ElementsAre(0, 0, 0, 0, 1, 1));
}

TEST(Crf, TermsStayFiniteForCertainProbabilities) {
    MeshFeatures features = strip_of_faces(2);
    features.dihedral[0] = 0;
    const CrfTerms terms = make_crf_terms(features, std::vector<float>{0, 1, 1, 0}, 2, std::vector<float>{0});
    for (const float value : terms.unary) EXPECT_TRUE(std::isfinite(value));
    EXPECT_TRUE(std::isfinite(terms.boundary[0]));
    EXPECT_EQ(terms.dihedral[0], 0.0F);
}

TEST(LabelComponents, ArePiecesOfEqualLabel) {
    const MeshFeatures features = strip_of_faces(6);
    const LabelComponents pieces =
        label_components(features.edges, features.face_area, std::vector<std::int32_t>{2, 2, 0, 2, 2, 2});
    EXPECT_THAT(pieces.of_face, ElementsAre(0, 0, 1, 2, 2, 2));
    EXPECT_THAT(pieces.label, ElementsAre(2, 0, 2));
    EXPECT_FLOAT_EQ(pieces.area_share[2], 0.5F);
}

TEST(MergeSmallComponents, JoinsTheNeighborTouchedMost) {
    MeshFeatures features = strip_of_faces(5);
    features.edge_length[1] = 3;  // between faces 1 and 2
    std::vector<std::int32_t> labels{0, 0, 1, 2, 2};
    CrfParameters parameters;
    parameters.merge_fraction = 0.5;
    const std::vector<float> smallest{0.1F, 0.9F, 0.1F};
    merge_small_components(features, parameters, smallest, labels);
    EXPECT_THAT(labels, ElementsAre(0, 0, 0, 2, 2));
    labels = {0, 0, 1, 2, 2};
    parameters.merge_fraction = 0;
    merge_small_components(features, parameters, smallest, labels);
    EXPECT_THAT(labels, ElementsAre(0, 0, 1, 2, 2)) << "0 turns merging off";
}

TEST(MergeSmallComponents, APieceWithoutNeighborsStays) {
    MeshFeatures features = strip_of_faces(2);
    std::vector<std::int32_t> labels{1, 1};
    CrfParameters parameters;
    parameters.merge_fraction = 10;
    merge_small_components(features, parameters, std::vector<float>{1, 1}, labels);
    EXPECT_THAT(labels, ElementsAre(1, 1));
}

TEST(LearnCrf, FindsParametersThatRemoveNoise) {
    const std::size_t faces = 60;
    const MeshFeatures features = strip_of_faces(faces);
    std::vector<std::int32_t> truth(faces, 0);
    std::vector<float> probabilities;
    for (std::size_t f = 0; f < faces; ++f) {
        truth[f] = f >= faces / 2 ? 1 : 0;
        const bool noisy = f % 7 == 3;
        const float right = noisy ? 0.35F : 0.8F;
        probabilities.push_back(truth[f] == 0 ? right : 1 - right);
        probabilities.push_back(truth[f] == 1 ? right : 1 - right);
    }
    const CrfExample example{&features,
                             make_crf_terms(features, probabilities, 2, std::vector<float>(faces - 1, 0.5F)),
                             truth,
                             {0.5F, 0.5F}};
    CrfSearchReport report;
    std::size_t calls = 0;
    const std::vector<bool> touching{false, true, true, false};
    const CrfParameters best = learn_crf(
        std::span(&example, 1), 2, touching, [&] { ++calls; }, report);
    EXPECT_GT(report.error_without_cut, 0.1);
    EXPECT_EQ(report.error, 0);
    EXPECT_EQ(solve_crf(features, example.terms, best), truth);
    EXPECT_EQ(calls, report.evaluations);
    EXPECT_LE(calls, crf_search_evaluations(2, touching));
}

TEST(EdgeContext, AveragesBoundaryProbabilityPerRange) {
    MeshFeatures features = strip_of_faces(3);
    features.edge_length = {1, 3};
    features.edge_context.begin = {0, 2, 2};
    features.edge_context.edge = {0, 1};
    features.edge_context.bin = {0, 4};
    std::vector<float> out(EdgeNeighborhood::k_bins * 2, -1);
    accumulate_edge_context(features, std::vector<float>{1, 0.5F}, out);
    EXPECT_THAT(out, ElementsAre(0.25F, 0, 0, 0, 0, 0, 0, 0, 0.375F, 0));
}

TEST(ContextColumns, ReplaceEarlierOnesAndCanBeDropped) {
    MeshFeatures features;
    features.unary.rows = 2;
    features.unary.add("a.x");
    const std::vector<std::string> two = context_names({"p", "q"}), three = context_names({"p", "q", "r"});
    EXPECT_EQ(two.size(), 70U);
    EXPECT_EQ(context_columns(features.unary, 1, three).size(), 210U);
    EXPECT_EQ(context_columns(features.unary, 1, two).size(), 140U);
    EXPECT_EQ(features.unary.cols(), 71U);
    drop_context_columns(features);
    EXPECT_THAT(features.unary.names, ElementsAre("a.x"));
    EXPECT_EQ(features.unary.values.size(), 2U);
}

}  // namespace
}  // namespace exemplar
