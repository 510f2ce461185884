#include "host/lines/extraction/outline_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/lines/extraction/measured_surface.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using test_support::MeasuredSurface;

LineOptions parallel(const Vec3& to_eye) {
    LineOptions options;
    options.eye = to_eye.normalized();
    options.parallel_eye = true;
    return options;
}

/// Returns the segments of contours along edges.
std::vector<LineSegment> edges_of(const MeasuredSurface& surface, const LineOptions& options) {
    std::vector<LineSegment> segments = extract_lines(surface.surface(), LineType::contours, options);
    std::erase_if(segments, [](const LineSegment& s) { return !runs_along_edge(LineType::contours, s); });
    return segments;
}

Vec3 end_of(const MeasuredSurface& surface, const LineSegment& segment, std::size_t end) {
    Vec3 point = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i)
        point += segment.ends[end][i] * surface.mesh.vertices[surface.mesh.faces[segment.face][i]];
    return point;
}

TEST(ContoursAlongEdges, OfABoxAreItsOutline) {
    const MeasuredSurface box(shapes::box(1, 2, 3, 1), true);
    const std::vector<LineSegment> all = extract_lines(box.surface(), LineType::contours, parallel({1, 2, 3}));
    const std::vector<LineSegment> edges = edges_of(box, parallel({1, 2, 3}));
    EXPECT_EQ(edges.size(), 6);
    EXPECT_EQ(all.size(), edges.size());  // and nothing runs across its sides
    // Each edge of the outline has one side towards the eye and one away, so it is off both corners on the view axis.
    for (const LineSegment& segment : edges)
        for (const std::size_t end : {0, 1})
            for (const float sign : {1.0f, -1.0f})
                EXPECT_GT((end_of(box, segment, end) - sign * Vec3(0.5f, 1, 1.5f)).norm(), 0.5f);
}

TEST(Outlines, DoNotDependOnOrientation) {
    TriangleMesh mesh = shapes::box(1, 2, 3, 1);
    for (std::size_t f = 0; f < mesh.face_count(); f += 3) std::swap(mesh.faces[f][1], mesh.faces[f][2]);
    const MeasuredSurface box(mesh);
    std::size_t count = 0;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        for (std::uint32_t i = 0; i < 3; ++i) count += is_outline(box.surface(), f, i, parallel({1, 2, 3})) ? 1 : 0;
    EXPECT_EQ(count, 2 * 6);
}

TEST(ContoursAlongEdges, AreTheNearerEndsOfFacesSeenEdgeOn) {
    // From the front of a box its sides are seen edge-on: the outline is that of the front, not that of the back.
    const MeasuredSurface box(shapes::box(1, 2, 3, 1), true);
    const std::vector<LineSegment> edges = edges_of(box, parallel({0, 0, 1}));
    EXPECT_EQ(edges.size(), 4);
    for (const LineSegment& segment : edges)
        for (const std::size_t end : {0, 1}) EXPECT_FLOAT_EQ(end_of(box, segment, end).z(), 1.5f);
}

TEST(ContoursAlongEdges, OfManyFacesAreWhereAllAreOnOneSide) {
    // Three half planes around the z axis, at 0, 90 and 180 degrees.
    TriangleMesh fan;
    fan.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5f}, {0, 1, 0.5f}, {-1, 0, 0.5f}};
    fan.faces = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
    const MeasuredSurface surface(fan, true);
    EXPECT_EQ(edges_of(surface, parallel({1, -0.2f, 0})).size(), 0);
    fan.vertices[4] = {-0.8f, 0.3f, 0.5f};
    EXPECT_EQ(edges_of(MeasuredSurface(fan, true), parallel({1, -0.2f, 0})).size(), 1);
    EXPECT_EQ(edges_of(MeasuredSurface(fan, true), parallel({0.2f, -1, 0})).size(), 0);
}

TEST(ContoursAlongEdges, AreBoundariesIfWanted) {
    const MeasuredSurface sheet(shapes::grid(3, 2, 1), true);
    LineOptions options = parallel({1, 2, 3});
    EXPECT_EQ(edges_of(sheet, options).size(), 0);
    options.contours_at_boundaries = true;
    EXPECT_EQ(edges_of(sheet, options).size(), 10);
}

TEST(ContoursAlongEdges, JoinTheContoursOfSmoothSides) {
    // A cylinder seen from above its side: two lines along its side, half of the lower rim and all of the upper one but
    // where its side faces away, which is the other half.
    const MeasuredSurface cylinder(shapes::cylinder(1, 2, 64, 4, true), true);
    const LineOptions options = parallel({0.3f, 0.5f, 2});
    const std::vector<LineSegment> all = extract_lines(cylinder.surface(), LineType::contours, options);
    // What faces the eye is bounded by closed curves, so each end is at one other end, wherever contours change over.
    for (const LineSegment& segment : all)
        for (const std::size_t end : {0, 1}) {
            const Vec3 at = end_of(cylinder, segment, end);
            std::ptrdiff_t others = -1;
            for (const LineSegment& other : all)
                for (const std::size_t e : {0, 1}) others += (end_of(cylinder, other, e) - at).norm() < 0.12f ? 1 : 0;
            EXPECT_GE(others, 1) << at.transpose();
        }
}

TEST(Creases, OnTheOutlineAreLeftToContours) {
    const MeasuredSurface box(shapes::box(1, 2, 3, 1), true);
    LineOptions options = parallel({1, 2, 3});
    EXPECT_EQ(extract_lines(box.surface(), LineType::creases, options).size(), 12);
    options.no_creases_on_outline = true;
    EXPECT_EQ(extract_lines(box.surface(), LineType::creases, options).size(), 6);
}

TEST(Creases, AreNotBetweenFacesThatOnlyOrientationTellsApart) {
    TriangleMesh sheet = shapes::grid(1, 1, 1);
    std::swap(sheet.faces[1][1], sheet.faces[1][2]);
    EXPECT_TRUE(extract_lines(MeasuredSurface(sheet).surface(), LineType::creases, {}).empty());
}

}  // namespace
}  // namespace exemplar
