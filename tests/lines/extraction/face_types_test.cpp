#include "host/lines/extraction/face_types.h"

#include <gtest/gtest.h>

#include <array>

#include "host/core/errors.h"
#include "host/mesh/curvature/curvature_estimator.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

constexpr std::uint16_t k_contour = bit_of(LineType::contours), k_ridge = bit_of(LineType::ridges),
                        k_valley = bit_of(LineType::valleys);
constexpr std::array k_counted{LineType::ridges, LineType::valleys, LineType::apparent_ridges};

void expect_shares(const LineDifference::Shares& shares, double truth, double misclassified) {
    EXPECT_DOUBLE_EQ(shares.truth, truth);
    EXPECT_DOUBLE_EQ(shares.misclassified, misclassified);
}

TEST(LineDifference, CountsFacesThatHaveALineByOneButNotByTheOther) {
    LineDifference difference(k_counted);
    //                    right    missing   too many  another type         one of two right
    const FaceTypes truth{k_ridge, k_ridge, 0, k_ridge, k_ridge | k_valley, 0, 0, 0};
    const FaceTypes guess{k_ridge, 0, k_valley, k_valley, k_ridge, 0, 0, 0};
    difference.add(truth, guess);
    expect_shares(difference.of(LineType::ridges), 4.0 / 8, 2.0 / 8);
    expect_shares(difference.of(LineType::valleys), 1.0 / 8, 3.0 / 8);
    expect_shares(difference.of(LineType::apparent_ridges), 0, 0);
    expect_shares(difference.of_any(), 4.0 / 8, 4.0 / 8);
}

TEST(LineDifference, OtherTypesDoNotCount) {
    LineDifference difference(k_counted);
    difference.add(FaceTypes{k_contour, k_contour | k_ridge}, FaceTypes{0, k_ridge});
    expect_shares(difference.of(LineType::contours), 0, 0);
    expect_shares(difference.of_any(), 0.5, 0);
}

TEST(LineDifference, SumsAreMeansOverAllFaces) {
    LineDifference one(k_counted), other(k_counted);
    one.add(FaceTypes{k_ridge}, FaceTypes{0});
    other.add(FaceTypes{0, 0}, FaceTypes{0, 0});
    other.add(FaceTypes{k_ridge}, FaceTypes{k_ridge});
    one.add(other);
    expect_shares(one.of(LineType::ridges), 0.5, 0.25);
}

TEST(LineDifference, NothingIsNoShare) {
    const LineDifference nothing(k_counted);
    expect_shares(nothing.of_any(), 0, 0);
}

TEST(LineDifference, SurfacesMustBeTheSame) {
    LineDifference difference(k_counted);
    EXPECT_THROW(difference.add(FaceTypes{0, 0}, FaceTypes{0}), UsageError);
}

TEST(FaceTypes, AreThoseOfEveryTypeByItself) {
    const TriangleMesh mesh = shapes::torus(3, 1, 61, 23);
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    const VertexCurvature curvature = estimator.estimate(mesh.vertices, {.derivatives = true});
    const LineSurface surface{mesh.faces, mesh.vertices, estimator.normals(), curvature};
    const LineOptions options{.eye = {6.13f, 4.29f, 8.41f}, .feature_size = 0.5f, .thresholds = {}};
    FaceTypes types(mesh.face_count());
    const std::array both{LineType::contours, LineType::suggestive_contours};
    add_face_types(surface, both, options, types);
    std::size_t found = 0;
    for (const LineType type : both) {
        const std::vector<std::uint8_t> marks = classify_faces(surface, type, options);
        for (std::size_t f = 0; f < marks.size(); ++f) {
            EXPECT_EQ(marks[f] != 0, (types[f] & bit_of(type)) != 0);
            found += marks[f];
        }
    }
    EXPECT_GT(found, 100u);
}

}  // namespace
}  // namespace exemplar
