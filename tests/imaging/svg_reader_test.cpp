#include "host/imaging/vectors/svg_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "host/core/errors.h"
#include "host/imaging/vectors/path_data.h"

namespace exemplar {
namespace {

using Eigen::Vector2d;
using testing::HasSubstr;

SvgPicture picture_of(const std::string& elements, const std::string& page = "viewBox=\"0 0 100 80\"") {
    return read_svg("<?xml version=\"1.0\"?>\n<svg " + page + ">" + elements + "</svg>", "x.svg");
}

SvgStroke stroke_of(const std::string& elements) {
    const SvgPicture picture = picture_of(elements);
    EXPECT_EQ(picture.strokes.size(), 1u);
    return picture.strokes.at(0);
}

void expect_refused(const std::string& elements, const std::string& says,
                    const std::string& page = "viewBox=\"0 0 100 80\"") {
    try {
        picture_of(elements, page);
        FAIL() << elements;
    } catch (const DataError& error) {
        EXPECT_THAT(error.what(), HasSubstr("x.svg: "));
        EXPECT_THAT(error.what(), HasSubstr(says));
        EXPECT_THAT(error.what(), HasSubstr("export it as PNG"));
    }
}

TEST(PathData, CommandsInAllForms) {
    const auto lines = flattened_path("M1,2 3 4l1-1.5.5.5H0v+2z m10 10 L20 20", 0.01);
    ASSERT_EQ(lines.size(), 2u);
    const std::vector<Vector2d> first{{1, 2}, {3, 4}, {4, 2.5}, {4.5, 3}, {0, 3}, {0, 5}};
    EXPECT_EQ(lines[0].points, first);
    EXPECT_TRUE(lines[0].closed);
    EXPECT_EQ(lines[1].points, (std::vector<Vector2d>{{11, 12}, {20, 20}}));
    EXPECT_FALSE(lines[1].closed);
}

TEST(PathData, CurvesAreFlattenedToTheirTolerance) {
    // A circle of four arcs, of cubic curves as drawing programs write it, and an ellipse that is turned.
    for (const char* data :
         {"M10 0A10 10 0 0 1 0 10A10 10 0 0 1-10 0a10 10 0 01 10-10A10 10 0 0 1 10 0",
          "M10 0C10 5.5228 5.5228 10 0 10S-10 5.5228-10 0-5.5228-10 0-10 10-5.5228 10 0", "M10 0A10 10 77 1 0 0 10"}) {
        const std::vector<Polyline> lines = flattened_path(data, 0.001);
        for (const Vector2d& point : lines.at(0).points) EXPECT_NEAR(point.norm(), 10, 0.004);
    }
    const auto arc = flattened_path("M10 0A10 10 77 1 0 0 10", 0.001).at(0).points;
    EXPECT_LT(arc[arc.size() / 2].x() + arc[arc.size() / 2].y(), -10) << "the long way around";
    const auto parabola = flattened_path("M0 0Q1 0 2 4T4 16", 0.001).at(0).points;
    for (const Vector2d& point : parabola)
        if (point.x() <= 2) {
            EXPECT_NEAR(point.y(), point.x() * point.x(), 0.01);
        }
}

TEST(PathData, OthersAreRefusedWithTheirPlace) {
    for (const char* data : {"L1 2", "M1", "M1 2 3", "M1 2X", "M1 2A3 4 0 2 0 5 6", "M1 1e999", "M1 2z3 4", "Mnan 1"})
        EXPECT_THROW(flattened_path(data, 0.01), UsageError) << data;
    EXPECT_EQ(svg_numbers(" 1,2 -3.5e1"), (std::vector<double>{1, 2, -35}));
}

TEST(SvgReader, LooksOfStrokesComeFromAllSides) {
    const SvgStroke stroke = stroke_of(
        "<style>.pen, .other{stroke:#204060;stroke-width:2}</style>"
        "<g transform=\"translate(10 5) scale(2)\" opacity=\"0.5\"><path class=\"pen\" stroke=\"red\" "
        "style=\"stroke-opacity:50%\" d=\"M0 0L10 0\" transform=\"rotate(90)\"/></g>");
    EXPECT_EQ(stroke.color, (Color{0x20, 0x40, 0x60}));
    EXPECT_DOUBLE_EQ(stroke.width, 4);
    EXPECT_DOUBLE_EQ(stroke.opacity, 0.25);
    EXPECT_LT((stroke.points.at(0) - Vector2d(10, 5)).norm(), 1e-9);
    EXPECT_LT((stroke.points.at(1) - Vector2d(10, 25)).norm(), 1e-9);
}

TEST(SvgReader, ShapesAreLines) {
    const SvgPicture picture = picture_of(
        "<g stroke=\"rgb(0,0,0)\" stroke-width=\"1px\"><line x1=\"1\" y1=\"2\" x2=\"3\" y2=\"4\"/>"
        "<polyline points=\"0,0 5,5 9,0\"/><polygon points=\"0,0 5,5 9,0\"/>"
        "<rect x=\"1\" y=\"1\" width=\"4\" height=\"3\"/><circle cx=\"50\" cy=\"40\" r=\"9\"/>"
        "<ellipse cx=\"50\" cy=\"40\" rx=\"9\" ry=\"5\"/></g>");
    ASSERT_EQ(picture.strokes.size(), 6u);
    EXPECT_FALSE(picture.strokes[1].closed);
    EXPECT_TRUE(picture.strokes[2].closed);
    EXPECT_EQ(picture.strokes[3].points.size(), 4u);
    for (const Vector2d& point : picture.strokes[4].points) EXPECT_NEAR((point - Vector2d(50, 40)).norm(), 9, 0.01);
}

TEST(SvgReader, WhatIsNotSeenIsLeftOut) {
    const SvgStroke stroke = stroke_of(
        "<defs><path stroke=\"#000\" d=\"M0 0L1 1\"/></defs>"
        "<g display=\"none\"><path stroke=\"#000\" d=\"M0 0L2 2\"/></g>"
        "<path style=\"visibility:hidden;stroke:#000\" d=\"M0 0L3 3\"/><path fill=\"#000\" d=\"M0 0L4 4\"/>"
        "<path stroke=\"#000\" stroke-width=\"0\" d=\"M0 0L5 5\"/><path stroke=\"black\" d=\"M0 0L6 6\"/>");
    EXPECT_EQ(stroke.points.at(1), Vector2d(6, 6));
}

TEST(SvgReader, GroupsAndThePageAreTold) {
    const SvgPicture picture = picture_of(
        "<g inkscape:groupmode=\"layer\" inkscape:label=\"Outlines\" id=\"layer1\" xmlns:inkscape=\"i\"><g id=\"g7\">"
        "<path stroke=\"#000\" d=\"M10 20L11 21\"/></g></g>",
        "viewBox=\"10 20 50 40\" width=\"9cm\"");
    EXPECT_DOUBLE_EQ(picture.width, 50);
    EXPECT_EQ(picture.strokes.at(0).points.at(0), Vector2d(0, 0));
    const SvgGroup& inner = picture.groups.at(static_cast<std::size_t>(picture.strokes[0].group));
    EXPECT_EQ(inner.name, "g7");
    EXPECT_EQ(picture.groups.at(static_cast<std::size_t>(inner.outer)).name, "Outlines");
    EXPECT_NEAR(picture_of("<path stroke=\"#000\" d=\"M0 0h1\"/>", "width=\"25.4mm\" height=\"1in\"").width, 96, 1e-9);
}

TEST(SvgReader, WhatIsNotReadIsNamed) {
    const std::string path = "<path stroke=\"#000\" d=\"M0 0L1 1\"/>";
    expect_refused("<path stroke=\"#000\" stroke-dasharray=\"3 1\" d=\"M0 0L1 1\"/>", "strokes with dashes");
    expect_refused(path + "\n<use href=\"#a\"/>", "line 3: an SVG with copies (<use>)");
    expect_refused("<path stroke=\"url(#g)\" d=\"M0 0L1 1\"/>", "strokes of color 'url(#g)'");
    expect_refused("<path stroke=\"#000\" d=\"M0 0K1 1\"/>", "an unknown command at character");
    expect_refused("<path fill=\"#000\" d=\"M0 0L1 1\"/>", "without strokes");
    expect_refused(path, "no size of its page", "");
    expect_refused("<path", "not a readable SVG");
    expect_refused("<path stroke=\"#000\" transform=\"twist(3)\" d=\"M0 0L1 1\"/>", "a transform 'twist' of 1 number");
    // Messages quote the first 40 bytes of a long text, and cut no character in two.
    expect_refused("<path stroke=\"#000\" transform=\"" + std::string(1000, 'y') + "(3)\" d=\"M0 0L1 1\"/>",
                   "a transform '" + std::string(40, 'y') + "' of 1 number");
    std::string umlauts = "a";
    for (int i = 0; i < 30; ++i) umlauts += "\xc3\xa4";
    expect_refused("<path stroke=\"" + umlauts + "\" d=\"M0 0L1 1\"/>", "color '" + umlauts.substr(0, 39) + "'");
    EXPECT_TRUE(is_svg("\xef\xbb\xbf<?xml version=\"1.0\"?><!-- a --><svg>"));
    EXPECT_FALSE(is_svg("<html>"));
}

}  // namespace
}  // namespace exemplar
