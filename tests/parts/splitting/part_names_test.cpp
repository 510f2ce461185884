#include "host/parts/splitting/part_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/core/errors.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

/// A body with two legs on each side in x, of which two pairs mirror each other, and a tail.
struct Figure {
    TriangleMesh mesh = shapes::box(1, 4, 2, 4);
    FaceLabels labels{{"body", "leg", "nothing"}, {}};

    Figure() {
        labels.label.assign(mesh.face_count(), 0);
        for (const float x : {-1.5f, 1.5f})
            for (const float y : {-1.0f, 1.2f}) add_leg(Vec3(x, y, 0));
    }
    void add_leg(const Vec3& center) {
        mesh = shapes::joined(mesh, shapes::translated(shapes::box(0.5f, 0.5f, 1, 2), center));
        labels.label.resize(mesh.face_count(), 1);
        mesh.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
    }
};

TEST(PartNames, LabelsThatOccurAreParts) {
    Figure figure;
    figure.labels.label[3] = -1;
    const MeshParts parts = parts_by_label(figure.mesh, figure.labels);
    EXPECT_THAT(parts.names, ElementsAre("body", "leg", "unlabeled"));
    EXPECT_THAT(parts.labels, ElementsAre(0, 1, -1));
    EXPECT_EQ(parts.part_of_face[3], 2u);
    EXPECT_EQ(parts.part_of_face[0], 0u);
    EXPECT_EQ(parts.part_of_face.back(), 1u);
}

TEST(PartNames, MirroredPiecesAreLeftAndRight) {
    const Figure figure;
    const MeshParts parts = parts_by_piece(figure.mesh, figure.labels);
    EXPECT_THAT(parts.names, UnorderedElementsAre("body", "leg_left_1", "leg_left_2", "leg_right_1", "leg_right_2"));
    std::vector<Vec3> sum(parts.names.size(), Vec3::Zero());
    const std::vector<Vec3> centers = face_centers(figure.mesh);
    for (std::size_t f = 0; f < centers.size(); ++f) sum[parts.part_of_face[f]] += centers[f];
    for (std::size_t p = 0; p < sum.size(); ++p) {
        if (parts.names[p] == "body") continue;
        EXPECT_EQ(sum[p].x() > 0, parts.names[p].find("left") != std::string::npos) << parts.names[p];
    }
}

TEST(PartNames, PiecesWithoutAPartnerAreNumberedByArea) {
    TriangleMesh mesh = shapes::icosphere(2, 1);
    FaceLabels labels{{"a", "b"}, std::vector<std::int32_t>(mesh.face_count(), 0)};
    mesh = shapes::joined(mesh, shapes::translated(shapes::icosphere(2, 3), Vec3(5, 1, 2)));
    labels.label.resize(mesh.face_count(), 0);
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
    const MeshParts parts = parts_by_piece(mesh, labels);
    EXPECT_THAT(parts.names, ElementsAre("a_2", "a_1"));
}

TEST(PartNames, NamesAreDistinct) {
    TriangleMesh mesh = shapes::grid(2, 2, 1);
    const FaceLabels labels{{"a", "a", "unlabeled"}, {0, 1, -1, 2, 0, 1, 2, -1}};
    EXPECT_THAT(parts_by_label(mesh, labels).names, ElementsAre("a", "a_2", "unlabeled", "unlabeled_2"));
}

TEST(PartNames, RefuseLabelsOfAnotherMesh) {
    EXPECT_THROW(parts_by_label(shapes::grid(2, 2, 1), {{"a"}, {0, 0}}), UsageError);
    EXPECT_THROW(parts_by_piece(shapes::grid(1, 1, 1), {{"a"}, {0, 1}}), UsageError);
}

}  // namespace
}  // namespace exemplar
