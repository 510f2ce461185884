#include "host/parts/transfer/transfer_labels.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <numbers>

#include "host/core/errors.h"
#include "host/mesh/editing/simplify.h"
#include "host/parts/transfer/surface_samples.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

std::vector<std::int32_t> label_by(const TriangleMesh& mesh, const std::function<int(const Vec3&)>& label) {
    std::vector<std::int32_t> labels;
    for (const Vec3& center : face_centers(mesh)) labels.push_back(label(center));
    return labels;
}

double area_right(const TriangleMesh& mesh, const std::vector<std::int32_t>& label,
                  const std::vector<std::int32_t>& truth) {
    const std::vector<float> areas = face_areas(mesh);
    double right = 0, total = 0;
    for (std::size_t f = 0; f < areas.size(); ++f) {
        total += areas[f];
        if (label[f] == truth[f]) right += areas[f];
    }
    return right / total;
}

TEST(SurfaceSamples, SpreadOverTheArea) {
    const TriangleMesh mesh = shapes::box(2, 1, 1, 3);
    const SurfaceSamples samples = sample_faces(mesh, 5000, 4096);
    EXPECT_NEAR(static_cast<double>(samples.points.size()), 5000, 800);
    ASSERT_EQ(samples.begin.size(), mesh.face_count() + 1);
    Vec3d mean = Vec3d::Zero();
    for (std::size_t p = 0; p < samples.points.size(); ++p) {
        EXPECT_GE(p, samples.begin[samples.face[p]]);
        EXPECT_LT(p, samples.begin[samples.face[p] + 1]);
        mean += samples.points[p].cast<double>();
        const Vec3 from_surface = samples.points[p].cwiseAbs() - Vec3(1, 0.5F, 0.5F);
        EXPECT_NEAR(from_surface.maxCoeff(), 0, 1e-5);
    }
    EXPECT_NEAR((mean / static_cast<double>(samples.points.size())).norm(), 0, 1e-5);
    EXPECT_EQ(sample_faces(mesh, 1, 9).points.size(), mesh.face_count());
}

TEST(TransferLabels, TheSameMeshKeepsItsLabels) {
    const TriangleMesh mesh = shapes::torus(1, 0.3F, 40, 20);
    const auto truth = label_by(mesh, [](const Vec3& p) { return p.x() > 0.2F ? 0 : p.y() > 0 ? 1 : 2; });
    const TransferredLabels found = transfer_labels(mesh, truth, mesh);
    EXPECT_GT(area_right(mesh, found.label, truth), 0.99);
    EXPECT_GT(found.sure_share, 0.85);
    EXPECT_LT(found.median_distance, 0.02);
}

TEST(TransferLabels, AnotherResolutionGetsThem) {
    const auto rule = [](const Vec3& p) { return p.z() > 0.3F ? 0 : p.x() > 0 ? 1 : 3; };
    const TriangleMesh fine = shapes::icosphere(5, 1), coarse = shapes::icosphere(3, 1);
    const auto truth_fine = label_by(fine, rule), truth_coarse = label_by(coarse, rule);
    EXPECT_GT(area_right(coarse, transfer_labels(fine, truth_fine, coarse).label, truth_coarse), 0.97);
    EXPECT_GT(area_right(fine, transfer_labels(coarse, truth_coarse, fine).label, truth_fine), 0.95);
}

TEST(TransferLabels, NormalsTellTheSidesOfAThinPlateApart) {
    const TriangleMesh mesh = shapes::box(2, 2, 0.01F, 8), other = shapes::box(2, 2, 0.01F, 5);
    const auto rule = [](const Vec3& p) { return p.z() > 0 ? 1 : 0; };
    EXPECT_GT(area_right(other, transfer_labels(mesh, label_by(mesh, rule), other).label, label_by(other, rule)), 0.98);
}

TEST(TransferLabels, OrderOfFacesDoesNotMatter) {
    const TriangleMesh mesh = shapes::icosphere(3, 1);
    const auto rule = [](const Vec3& p) { return p.z() > 0.3F ? 0 : 1; };
    const TriangleMesh shuffled = shapes::with_shuffled_faces(mesh, 5);
    const auto labels = transfer_labels(shuffled, label_by(shuffled, rule), mesh).label;
    EXPECT_EQ(labels, transfer_labels(mesh, label_by(mesh, rule), mesh).label);
}

TEST(TransferLabels, FarSurfacesAreUnsure) {
    const TriangleMesh mesh = shapes::icosphere(3, 1);
    const auto truth = label_by(mesh, [](const Vec3&) { return 0; });
    const TransferredLabels found = transfer_labels(mesh, truth, shapes::translated(mesh, Vec3(3, 0, 0)));
    EXPECT_EQ(found.sure_share, 0);
    EXPECT_EQ(found.label, truth);
    EXPECT_GT(found.median_distance, 1);
}

TEST(TransferLabels, UnlabeledStaysUnlabeled) {
    const TriangleMesh mesh = shapes::icosphere(3, 1);
    const auto truth = label_by(mesh, [](const Vec3& p) { return p.z() > 0 ? -1 : 1; });
    EXPECT_GT(area_right(mesh, transfer_labels(mesh, truth, mesh).label, truth), 0.97);
    EXPECT_THROW(transfer_labels(mesh, std::vector<std::int32_t>(3, 0), mesh), UsageError);
    EXPECT_THROW(transfer_labels(TriangleMesh(), {}, mesh), MeshError);
}

}  // namespace
}  // namespace exemplar
