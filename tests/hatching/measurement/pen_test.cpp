#include "host/hatching/measurement/pen.h"

#include <gtest/gtest.h>

#include <vector>

#include "host/hatching/fields/ink.h"
#include "host/hatching/hatching_drawing.h"
#include "host/hatching/measurement/stroke_measurements.h"

namespace exemplar {
namespace {

constexpr int k_ends_width = 240, k_ends_height = 200;

/// Measures the taper of strokes that are a little askew, drawn with a taper.
float measured_taper(float taper, int count) {
    std::vector<HatchStroke> strokes;
    for (int i = 0; i < count; ++i) {
        HatchStroke& stroke = strokes.emplace_back();
        const int row = i / 2;
        const float x = i % 2 == 0 ? 30.2f : 140.6f, y = 12.3f + 9.1f * static_cast<float>(row);
        for (int k = 0; k <= 120; ++k) {
            stroke.points.emplace_back(x + 0.6f * static_cast<float>(k), y + 0.04f * static_cast<float>(k));
            stroke.widths.push_back(3);
        }
        stroke.darkness = 0.9f;
    }
    taper_strokes(strokes, taper);
    FloatImage darkness(k_ends_width, k_ends_height, 1);
    darkness.data = render_ink(strokes, k_ends_width, k_ends_height);
    return measure_strokes(darkness, Image(k_ends_width, k_ends_height, 1, 255)).taper;
}

TEST(Pen, TheTaperIsMeasured) {
    EXPECT_LT(measured_taper(0, 36), 1.2f);
    EXPECT_NEAR(measured_taper(4, 36), 4, 1.5f);
    EXPECT_NEAR(measured_taper(8, 36), 8, 2);
}

TEST(Pen, OutlinesAreAsWideInBlackAsTheirInk) {
    HatchStroke stroke;
    TracedStroke line;
    for (int k = 0; k <= 150; ++k) {
        stroke.points.emplace_back(20.3f + static_cast<float>(k), 40.2f + 0.3f * static_cast<float>(k));
        stroke.widths.push_back(3);
        line.points.push_back({});
        line.points.back().center = stroke.points.back();
    }
    stroke.darkness = 0.5f;
    line.width = 3;
    orient_along(line);
    FloatImage darkness(k_ends_width, k_ends_height, 1);
    darkness.data = render_ink(std::span(&stroke, 1), k_ends_width, k_ends_height);
    EXPECT_NEAR(measure_line_width(darkness, 0, std::span(&line, 1)), 1.5f, 0.1f);
    EXPECT_EQ(measure_line_width(darkness, 0, {}), 0);
}

TEST(Pen, FewEndsTellNothing) {
    EXPECT_EQ(measured_taper(0, 8), k_usual_taper);
}

}  // namespace
}  // namespace exemplar
