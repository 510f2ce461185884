#include "host/lines/part_inks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/core/errors.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr Color k_red{255, 0, 0};

/// A straight stroke with a point per pixel, each piece on the face of its number.
Stroke stroke_over_faces(std::size_t faces) {
    Stroke stroke;
    for (std::size_t i = 0; i <= faces; ++i) {
        StrokePoint& point = stroke.points.emplace_back();
        point.position = {static_cast<float>(i), 0};
        point.parameter = static_cast<float>(i);
        point.width = 2;
        point.face = static_cast<std::uint32_t>(std::min(i, faces - 1));
    }
    return stroke;
}

std::vector<float> places_of(const Stroke& stroke) {
    std::vector<float> places;
    for (const StrokePoint& point : stroke.points) places.push_back(point.position.x());
    return places;
}

TEST(PartInks, AreThoseOfTheLabels) {
    const TriangleMesh mesh = shapes::grid(2, 1, 1);  // four triangles
    const FaceLabels labels{{"torso", "leg", "tail"}, {0, 1, 2, -1}};
    const PartInks inks = inks_of_parts(mesh, labels, {{"torso", {k_red, 2}}, {"*", {{}, 0.5F}}, {"tail", {}}});
    ASSERT_EQ(inks.inks.size(), 3U);
    EXPECT_EQ(inks.inks[0], PartInk{});
    EXPECT_EQ(inks.inks[inks.ink_of_face[0]], (PartInk{k_red, 2}));
    EXPECT_EQ(inks.names[inks.ink_of_face[0]], "torso");
    EXPECT_EQ(inks.inks[inks.ink_of_face[1]], (PartInk{{}, 0.5F}));
    EXPECT_EQ(inks.ink_of_face[2], 0U) << "its own ink is that of the style";
    EXPECT_EQ(inks.ink_of_face[3], 0U) << "no label";
}

TEST(PartInks, RefuseLabelsThatDoNotFit) {
    const TriangleMesh mesh = shapes::grid(2, 1, 1);
    const std::map<std::string, PartInk> legs{{"legs", {k_red, 1}}};
    EXPECT_THROW(inks_of_parts(mesh, {{"leg"}, {0, 0}}, legs), UsageError);
    EXPECT_THAT(mesh_files::error_of<UsageError>([&] {
                    inks_of_parts(mesh, {{"leg", "arm"}, {0, 0, 0, 1}}, legs);
                }),
                HasSubstr("leg, arm"));
}

TEST(StrokesByInk, DivideStrokesWhereTheInkChanges) {
    const PartInks inks{{{}, {k_red, 3}, {{}, 0}}, {"", "torso", "leg"}, {0, 0, 1, 1, 1, 2, 0}};
    const Stroke stroke = stroke_over_faces(7);
    const std::vector<InkedStrokes> divided = strokes_by_ink({&stroke, 1}, inks);
    ASSERT_EQ(divided.size(), 2U) << "the leg has no strokes";
    EXPECT_EQ(divided[0].ink, 0U);
    ASSERT_EQ(divided[0].strokes.size(), 2U);
    EXPECT_THAT(places_of(divided[0].strokes[0]), ElementsAre(0, 1, 2));
    EXPECT_THAT(places_of(divided[0].strokes[1]), ElementsAre(6, 7));
    EXPECT_EQ(divided[0].strokes[0].points[2].width, 2);
    EXPECT_EQ(divided[1].ink, 1U);
    ASSERT_EQ(divided[1].strokes.size(), 1U);
    EXPECT_THAT(places_of(divided[1].strokes[0]), ElementsAre(2, 3, 4, 5));
    EXPECT_EQ(divided[1].strokes[0].points[0].width, 6);
}

TEST(StrokesByInk, LeaveOutWhatIsHidden) {
    const PartInks inks{{{}, {k_red, 1}}, {"", "torso"}, {1, 1, 1, 1}};
    Stroke stroke = stroke_over_faces(4);
    stroke.points[1].visible = false;
    const std::vector<InkedStrokes> divided = strokes_by_ink({&stroke, 1}, inks);
    ASSERT_EQ(divided.size(), 1U);
    ASSERT_EQ(divided[0].strokes.size(), 2U);
    EXPECT_THAT(places_of(divided[0].strokes[0]), ElementsAre(0, 1));
    EXPECT_THAT(places_of(divided[0].strokes[1]), ElementsAre(2, 3, 4));
}

TEST(StrokesByInk, KeepAClosedStrokeOfOneInkClosed) {
    Stroke ring = stroke_over_faces(4);
    ring.closed = true;
    ring.points.back() = ring.points.front();
    ring.points.back().parameter = 4;
    for (const bool two_inks : {false, true}) {
        const PartInks inks{{{}, {k_red, 1}}, {"", "torso"}, {1, 1, two_inks ? 0U : 1U, 1}};
        const std::vector<InkedStrokes> divided = strokes_by_ink({&ring, 1}, inks);
        EXPECT_EQ(divided.back().strokes.front().closed, !two_inks);
        EXPECT_EQ(divided.size(), two_inks ? 2U : 1U);
    }
}

}  // namespace
}  // namespace exemplar
