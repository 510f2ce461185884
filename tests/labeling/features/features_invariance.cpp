#include <map>
#include <set>

#include "host/core/parallel.h"
#include "host/shape/prepared_mesh.h"
#include "tests/labeling/features/features_support.h"

namespace exemplar {
namespace {

using namespace feature_tests;

const TriangleMesh& original() {
    static const TriangleMesh mesh = lopsided_torus(40, 24);
    return mesh;
}
FeatureOptions few_context_samples() {
    FeatureOptions options;
    options.samples = 300;
    return options;
}
const MeshFeatures& original_features() {
    static const MeshFeatures features = compute_features(original(), few_context_samples());
    return features;
}

TEST(Features, HasTheCountsAndDistinctNamesOfTheText) {
    const MeshFeatures& features = original_features();
    expect_finite(features, original().face_count());
    EXPECT_EQ(features.edges.size(), original().face_count() * 3 / 2);
    EXPECT_EQ(std::set(features.unary.names.begin(), features.unary.names.end()).size(), 678U);
    EXPECT_EQ(std::set(features.pairwise.names.begin(), features.pairwise.names.end()).size(), 186U);
    std::map<std::string, int> count;
    for (const std::string& name : features.unary.names) ++count[name.substr(0, name.find('.'))];
    const std::map<std::string, int> expected{{"curvature", 36}, {"pca", 75},      {"diameter", 60},
                                              {"medial", 60},    {"geodesic", 11}, {"shape_context", 270},
                                              {"spin", 100},     {"region", 66}};
    EXPECT_EQ(count, expected);
}

TEST(Features, EveryColumnTellsFacesApart) {
    const MeshFeatures& features = original_features();
    std::size_t constant = 0;
    for (std::size_t k = 0; k < features.unary.cols(); ++k) {
        const auto [low, high] = std::ranges::minmax(features.unary.column(k));
        if (high == low) ++constant;
    }
    EXPECT_LT(constant, 100U);  // far corners of spin images and steep angles far away stay empty
}

TEST(Features, OrientationAddsCenteredCoordinates) {
    FeatureOptions options = few_context_samples();
    options.orientation = true;
    const MeshFeatures features = compute_features(shapes::translated(original(), Vec3(5, -3, 2)), options);
    ASSERT_EQ(features.unary.cols(), 681U);
    const std::span<const float> y = column(features.unary, "orientation.y");
    double mean = 0.0, area = 0.0;
    for (std::size_t f = 0; f < y.size(); ++f) {
        mean += static_cast<double>(y[f]) * static_cast<double>(features.face_area[f]);
        area += static_cast<double>(features.face_area[f]);
    }
    EXPECT_NEAR(mean / area, 0.0, 1e-3);
}

TEST(Features, DoNotDependOnRotationTranslationAndScale) {
    TriangleMesh moved = shapes::rotated(original(), shapes::random_rotation(3));
    moved = shapes::translated(shapes::scaled(std::move(moved), 37.0F), Vec3(10, -20, 5));
    const MeshFeatures features = compute_features(moved, few_context_samples());
    EXPECT_LT(mismatched_share(original_features().unary, features.unary, 0.01F), 0.002);
    EXPECT_LT(mismatched_share(original_features().pairwise, features.pairwise, 0.01F), 0.002);
    EXPECT_EQ(original_features().context.sample_face, features.context.sample_face);
}

TEST(Features, DoNotDependOnFaceOrder) {
    std::vector<std::uint32_t> order;
    const TriangleMesh shuffled = shapes::with_shuffled_faces(original(), 9, &order);
    const MeshFeatures features = compute_features(shuffled, few_context_samples());
    EXPECT_LT(mismatched_share(original_features().unary, features.unary, 0.01F, order), 0.002);
    // Edges are sorted by their vertices, so their rows stay.
    EXPECT_LT(mismatched_share(original_features().pairwise, features.pairwise, 0.01F), 0.002);
}

// The two sides of a symmetric shape must look alike: no family may tell left from right.
TEST(Features, DoNotTellAMeshFromItsMirrorImage) {
    TriangleMesh mirrored = shapes::transformed(original(), [](const Vec3& p) -> Vec3 {
        return {-p.x(), p.y(), p.z()};
    });
    for (Face& face : mirrored.faces) std::swap(face[1], face[2]);
    const MeshFeatures features = compute_features(mirrored, few_context_samples());
    EXPECT_EQ(original_features().context.sample_face, features.context.sample_face);
    EXPECT_LT(mismatched_share(original_features().unary, features.unary, 0.01F), 0.002);
    EXPECT_LT(mismatched_share(original_features().pairwise, features.pairwise, 0.01F), 0.002);
}

/// Contextual features of a labeling by place on the original mesh, which a moved copy shares face by face.
FeatureMatrix contextual_features(const ContextGeometry& geometry) {
    constexpr std::size_t k_classes = 2;
    std::vector<float> probabilities(geometry.faces * k_classes);
    const std::vector<Vec3> centers = face_centers(original());
    for (std::size_t f = 0; f < geometry.faces; ++f) {
        probabilities[f * k_classes] = centers[f].x() > 0.8F ? 0.9F : 0.2F;
        probabilities[f * k_classes + 1] = 1.0F - probabilities[f * k_classes];
    }
    FeatureMatrix result;
    result.rows = geometry.faces;
    for (std::size_t k = 0; k < k_context_measures * k_context_bins * k_classes; ++k) {
        result.add("context." + std::to_string(k));
    }
    CpuContextHistograms().accumulate(geometry, probabilities, k_classes, result.values);
    return result;
}

TEST(Features, ContextualOnesDoNotDependOnRotationAndScale) {
    const ContextGeometry& context = original_features().context;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const TriangleMesh moved = shapes::scaled(shapes::rotated(original(), shapes::random_rotation(seed)), 0.02F);
        const ContextGeometry found = compute_features(moved, few_context_samples()).context;
        EXPECT_LT(mismatched_share(contextual_features(context), contextual_features(found), 0.01F), 0.002);
    }
}

TEST(Features, ContextualSamplesStandForAllFaces) {
    FeatureOptions all;
    all.samples = original().face_count();
    const FeatureMatrix exact = contextual_features(compute_features(original(), all).context);
    const FeatureMatrix sampled = contextual_features(original_features().context);
    std::vector<double> errors;
    for (std::size_t k = 0; k < exact.cols(); ++k) {
        double error = 0.0, sum = 0.0, squares = 0.0;
        const double n = static_cast<double>(exact.rows);
        for (std::size_t f = 0; f < exact.rows; ++f) {
            const double truth = static_cast<double>(exact.column(k)[f]);
            error += std::pow(static_cast<double>(sampled.column(k)[f]) - truth, 2);
            sum += truth;
            squares += truth * truth;
        }
        const double spread = std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)));
        if (spread > 1e-3) errors.push_back(std::sqrt(error / n) / spread);
    }
    ASSERT_GT(errors.size(), exact.cols() / 2);
    std::ranges::sort(errors);
    EXPECT_LT(errors[errors.size() / 2], 0.18);
}

TEST(Features, DoNotDependOnThreadCount) {
    const ThreadLimit limit(1);
    const MeshFeatures features = compute_features(original(), few_context_samples());
    EXPECT_EQ(original_features().unary.values, features.unary.values);
    EXPECT_EQ(original_features().pairwise.values, features.pairwise.values);
    EXPECT_EQ(original_features().edge_context.edge, features.edge_context.edge);
    EXPECT_EQ(original_features().context.geodesic_bin, features.context.geodesic_bin);
}

TEST(Features, AMeshTurnedInsideOutIsTurnedBack) {
    TriangleMesh inverted = original();
    for (Face& face : inverted.faces) std::swap(face[1], face[2]);
    const MeshFeatures features = compute_features(inverted, few_context_samples());
    for (const char* name : {"curvature.k1@0.1", "diameter.median@90", "medial.mean@60", "shape_context.5x4.d2a1"}) {
        const std::span<const float> a = column(original_features().unary, name), b = column(features.unary, name);
        std::size_t different = 0;
        const auto [low, high] = std::ranges::minmax(a);
        for (std::size_t f = 0; f < a.size(); ++f) different += std::abs(a[f] - b[f]) > 0.05F * (high - low);
        EXPECT_LT(different, a.size() / 50) << name;
    }
}

TEST(Features, AnInsideOutMeshWithHolesIsTurnedBack) {
    TriangleMesh open = original();
    open.faces.resize(open.faces.size() - 4);  // a hole of two quadrilaterals
    open.source_face_count = static_cast<std::uint32_t>(open.face_count());
    TriangleMesh inverted = open;
    for (Face& face : inverted.faces) std::swap(face[1], face[2]);
    const PreparedMesh a = prepare_mesh(open, 50), b = prepare_mesh(inverted, 50);
    ASSERT_EQ(a.mesh.faces, open.faces);
    for (std::size_t f = 0; f < open.face_count(); ++f) EXPECT_GT(a.normal[f].dot(b.normal[f]), 0.999F);
    // A sheet has no inside: whichever way it faces, it stays.
    TriangleMesh sheet = shapes::grid(6, 6, 1.0F);
    for (Face& face : sheet.faces) std::swap(face[1], face[2]);
    EXPECT_EQ(prepare_mesh(sheet, 50).mesh.faces, sheet.faces);
}

// A few hundred samples must tell what all faces tell: root mean square error against the spread of the true values.
TEST(Features, SamplesStandForAllFaces) {
    FeatureOptions all;
    all.samples = original().face_count();
    const MeshFeatures exact = compute_features(original(), all);
    const FeatureMatrix& sampled = original_features().unary;
    std::map<std::string, std::vector<double>> errors;
    for (std::size_t k = 0; k < sampled.cols(); ++k) {
        double error = 0.0, sum = 0.0, squares = 0.0;
        const double n = static_cast<double>(sampled.rows);
        for (std::size_t f = 0; f < sampled.rows; ++f) {
            const double truth = static_cast<double>(exact.unary.column(k)[f]);
            error += std::pow(static_cast<double>(sampled.column(k)[f]) - truth, 2);
            sum += truth;
            squares += truth * truth;
        }
        const double spread = std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)));
        if (spread > 1e-4) {
            errors[sampled.names[k].substr(0, sampled.names[k].find('.'))].push_back(std::sqrt(error / n) / spread);
        }
    }
    for (auto& [family, values] : errors) {
        std::ranges::sort(values);
        const bool summed =
            std::set<std::string>{"shape_context", "spin", "geodesic", "limb", "region"}.contains(family);
        const double bound = summed ? 0.15 : family == "pca" ? 0.1 : 0.05;
        EXPECT_LT(values[values.size() / 2], bound) << family;
    }
}

TEST(PreparedMesh, NormalsAreSmoothButKeepEdges) {
    const TriangleMesh box = shapes::box(1, 2, 3, 4);
    const std::vector<Vec3> of_box = face_normals(box);
    const PreparedMesh prepared_box = prepare_mesh(box, 50);
    for (std::size_t f = 0; f < of_box.size(); ++f) EXPECT_GT(prepared_box.normal[f].dot(of_box[f]), 0.99999F);

    Random random(4);
    const TriangleMesh rough = shapes::transformed(shapes::icosphere(4, 1.0F), [&](const Vec3& p) -> Vec3 {
        return p * static_cast<float>(1.0 + random.uniform(-0.01, 0.01));
    });
    const std::vector<Vec3> raw = face_normals(rough), centers = face_centers(rough);
    const PreparedMesh prepared = prepare_mesh(rough, 50);
    double raw_error = 0.0, error = 0.0;
    for (std::size_t f = 0; f < raw.size(); ++f) {
        raw_error += static_cast<double>((raw[f] - centers[f].normalized()).squaredNorm());
        error += static_cast<double>((prepared.normal[f] - centers[f].normalized()).squaredNorm());
    }
    EXPECT_LT(error, raw_error / 9.0);  // a third of the angle
}

// Where all neighbors lie on one side the normal must not be extrapolated from their noise.
TEST(PreparedMesh, NormalsAreSmoothAtBordersToo) {
    Random random(5);
    const TriangleMesh rough = shapes::transformed(shapes::grid(40, 4, 1.0F), [&](const Vec3& p) -> Vec3 {
        return p + Vec3(0, 0, static_cast<float>(random.uniform(-0.003, 0.003)));
    });
    const std::vector<Vec3> raw = face_normals(rough);
    const PreparedMesh prepared = prepare_mesh(rough, 50);
    const auto tilt = [](const Vec3& normal) { return static_cast<double>(normal.head<2>().squaredNorm()); };
    double raw_error = 0.0, error = 0.0;
    for (std::size_t f = 0; f < raw.size(); ++f) raw_error += tilt(raw[f]), error += tilt(prepared.normal[f]);
    EXPECT_LT(error, raw_error / 4.0);
}

TEST(PreparedMesh, UnitIsTheThirtiethPercentileOfDistances) {
    const PreparedMesh prepared = prepare_mesh(shapes::icosphere(4, 7.0F), 400);
    // On a sphere of radius r a cap of geodesic radius d holds (1 - cos(d / r)) / 2 of the area.
    double below = 0.0;
    for (std::size_t s = 0; s < prepared.sample_count(); ++s) {
        for (std::size_t f = 0; f < prepared.face_count(); ++f) {
            if (prepared.distance[s * prepared.face_count() + f] <= 1.0F) {
                below +=
                    static_cast<double>(prepared.samples.area_share[s]) * static_cast<double>(prepared.area_share[f]);
            }
        }
    }
    EXPECT_NEAR(below, 0.30, 0.005);
    const double ratio = static_cast<double>(prepared.median_distance);
    EXPECT_NEAR(ratio, std::acos(0.0) / std::acos(0.4), 0.05);
    EXPECT_NEAR(static_cast<double>(prepared.far_distance), std::acos(-0.9) / std::acos(0.4), 0.1);
}

}  // namespace
}  // namespace exemplar
