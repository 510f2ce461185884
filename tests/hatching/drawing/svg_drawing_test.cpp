#include "host/hatching/drawing/svg_drawing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "host/core/errors.h"
#include "host/hatching/fields/ink.h"

namespace exemplar {
namespace {

SvgDrawing drawing_of(const std::string& elements) {
    return svg_drawing(read_svg(
        "<svg viewBox=\"0 0 200 160\"><g stroke=\"#000\" stroke-width=\"2\">" + elements + "</g></svg>", "x.svg"));
}

StrokeMeasurements measured(const SvgDrawing& drawing) {
    const FloatImage darkness = svg_darkness(drawing, 200);
    return measure_paths(drawing.paths, darkness, Image(200, 160, 1, 1));
}

std::string parallel_lines(double spacing, double slope) {
    std::string lines;
    for (double y = 20; y < 120; y += spacing)
        lines += "<path d=\"M40 " + std::to_string(y) + "l100 " + std::to_string(100 * slope) + "\"/>";
    return lines;
}

TEST(SvgDrawing, StrokesAreMeasuredExactly) {
    const double slope = 0.3, spacing = 7;
    const StrokeMeasurements m = measured(drawing_of(parallel_lines(spacing, slope)));
    EXPECT_NEAR(m.median_thickness, 2, 1e-4);
    EXPECT_NEAR(m.median_spacing, spacing * std::cos(std::atan(slope)), 0.02);
    EXPECT_TRUE(m.intersections.empty());
    EXPECT_EQ(m.taper, 0);
    std::size_t centers = 0;
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (!m.skeleton[i]) continue;
        ++centers;
        EXPECT_NEAR(m.orientation[i], std::atan(slope), 1e-3);
        EXPECT_NEAR(m.intensity[i], 1, 1e-4);
        EXPECT_NEAR(m.thickness[i], 2, 1e-3);
        EXPECT_NEAR(m.length[i], 100 * std::hypot(1, slope), 0.1);
    }
    EXPECT_GT(centers, 1000u);
}

TEST(SvgDrawing, CrossingsAreFound) {
    std::string lines = parallel_lines(8, 0);
    for (int x = 50; x < 130; x += 8) lines += "<path d=\"M" + std::to_string(x) + " 15v105\"/>";
    const StrokeMeasurements m = measured(drawing_of(lines));
    EXPECT_NEAR(static_cast<double>(m.intersections.size()), 130, 8);
    EXPECT_EQ(m.level[60 * 200 + 90], 2);
}

TEST(SvgDrawing, TheTaperIsThatOfTheWidths) {
    std::string lines;
    for (int y = 20; y < 120; y += 8)
        for (int x = 0; x < 80; ++x) {  // pieces a pixel long; over six pixels the ends become thin
            const double end = std::min({x + 0.5, 79.5 - x, 6.0}) / 6, width = 3 * std::sqrt(end * (2 - end));
            lines += "<path d=\"M" + std::to_string(40 + x) + " " + std::to_string(y) + "h1\" stroke-width=\"" +
                     std::to_string(width) + "\"/>";
        }
    const SvgDrawing drawing = drawing_of(lines);
    EXPECT_EQ(drawing.paths.size(), 13u);
    EXPECT_NEAR(measured(drawing).taper, 6, 1.5);
}

TEST(SvgDrawing, PiecesOfAPenOfChangingWidthAreOneStroke) {
    const SvgDrawing drawing = drawing_of(
        "<path d=\"M10 10L20 10\" stroke-width=\"1\"/><path d=\"M20 10L30 11\" stroke-width=\"3\"/>"
        "<path d=\"M30 11L30 40\"/><path d=\"M50 10L60 10\"/>");
    ASSERT_EQ(drawing.paths.size(), 3u) << "the second turns, the third begins elsewhere";
    EXPECT_EQ(drawing.paths[0].points.size(), 3u);
    EXPECT_EQ(drawing.paths[0].widths, (std::vector<float>{1, 2, 3}));
}

TEST(SvgDrawing, LayersTellOutlinesAndOtherLines) {
    const SvgDrawing drawing = drawing_of(
        "<g id=\"Outline\"><g id=\"g1\"><path d=\"M0 0h9\"/></g></g><g id=\"ridges\"><path d=\"M0 0h9\"/></g>"
        "<g id=\"hatching\"><path d=\"M0 5h9\"/></g>");
    ASSERT_EQ(drawing.paths.size(), 2u);
    EXPECT_TRUE(drawing.paths[0].outline);
    EXPECT_FALSE(drawing.paths[1].outline);
    const StrokeMeasurements m = measured(drawing);
    EXPECT_NEAR(m.outline_width, 2, 1e-4);
}

TEST(SvgDrawing, ColoredLinesAreLeftOutOfADrawingInBlack) {
    const std::string blue = "<path d=\"M0 9h9\" stroke=\"#3060ff\"/>";
    EXPECT_EQ(drawing_of("<path d=\"M0 0h90\"/>" + blue).paths.size(), 1u);
    EXPECT_EQ(drawing_of(blue).paths.size(), 1u);
    EXPECT_NEAR(drawing_of("<path d=\"M0 0h90\" stroke=\"#808080\" opacity=\"0.5\"/>").paths[0].darkness, 0.25, 0.002);
    EXPECT_THROW(drawing_of("<path d=\"M0 0h90\" stroke=\"#fff\"/>"), DataError);
}

}  // namespace
}  // namespace exemplar
