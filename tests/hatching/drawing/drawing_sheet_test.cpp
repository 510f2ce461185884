#include "host/hatching/drawing/drawing_sheet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/hatching/drawing/drawing_input.h"
#include "host/hatching/drawing/plane_map.h"

namespace exemplar {
namespace {

using Eigen::Vector2d;

/// A view with a ball that gets darker to the right.
Image ball_view(int width, int height) {
    Image view(width, height, 1, 255);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (std::hypot(x - 0.5 * width, y - 0.5 * height) < 0.35 * height)
                view.pixel(x, y)[0] = static_cast<std::uint8_t>(240 - 150 * x / width);
    return view;
}

/// Draws black lines across the view on a sheet; returns how dark a pixel of the view is by them.
void draw_lines(Image& page, const DrawingSheet& sheet) {
    for (int y = 0; y < page.height; ++y)
        for (int x = 0; x < page.width; ++x) {
            const Vector2d view = (Vector2d(x + 0.5, y + 0.5) - sheet.view_corner) / sheet.view_scale;
            const bool inside =
                view.x() > 40 && view.y() > 40 && view.x() < sheet.view_width - 40 && view.y() < sheet.view_height - 40;
            if (inside && std::fmod(view.x() + 0.5 * view.y(), 10.0) < 2.5)
                std::ranges::fill(page.pixel(x, y), std::uint8_t{20});
        }
}

/// A picture of a page on a dark table, where the page's corners come to lie at `corners`, in uneven, warm light.
Image photograph(const Image& page, const std::array<Vector2d, 4>& corners, int width, int height) {
    const double w = page.width, h = page.height;
    const PlaneMap to_page(corners, {Vector2d(0, 0), Vector2d(w, 0), Vector2d(w, h), Vector2d(0, h)});
    Image photo(width, height, 3, 60);
    Random random(3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vector2d place = to_page.apply(Vector2d(x + 0.5, y + 0.5));
            if (place.x() < 0 || place.y() < 0 || place.x() > w || place.y() > h) continue;
            const auto value = mean_at(page, place, 2);
            const double light = 0.95 - 0.25 * x / width + 0.05 * y / height;
            for (std::size_t c = 0; c < 3; ++c)
                photo.pixel(x, y)[c] = static_cast<std::uint8_t>(
                    std::clamp(light * (c == 2 ? 0.9 : 1.0) * value[c] + 4 * (random.uniform() - 0.5), 0.0, 255.0));
        }
    return photo;
}

class PrintedSheet : public testing::Test {
  protected:
    const Image view_ = ball_view(300, 220);
    const DrawingSheet sheet_ = drawing_sheet("a5", view_.width, view_.height);
    const Image page_ = printed_sheet(sheet_, view_);
};

TEST_F(PrintedSheet, FillsThePaperAcrossForWideViews) {
    EXPECT_GT(sheet_.width, sheet_.height);
    EXPECT_NEAR(sheet_.width / sheet_.pixels_per_mm, 210, 0.1);
    EXPECT_NEAR(sheet_.height / sheet_.pixels_per_mm, 148, 0.1);
    const DrawingSheet tall = drawing_sheet("letter", 200, 300);
    EXPECT_LT(tall.width, tall.height);
    EXPECT_THROW(drawing_sheet("a4", 0, 10), UsageError);
    EXPECT_THROW(drawing_sheet("a9", 10, 10), UsageError);
    EXPECT_THROW(printed_sheet(sheet_, ball_view(10, 10)), UsageError);
}

TEST_F(PrintedSheet, MarksAreFoundAsTheyWerePrinted) {
    const auto marks = find_marks(page_);
    ASSERT_TRUE(marks);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(((*marks)[i] - sheet_.marks[i]).norm(), 1);
}

TEST_F(PrintedSheet, APhotographIsReadFromAnySideUpAndAslant) {
    Image page = page_;
    draw_lines(page, sheet_);
    const FloatImage truth = drawing_darkness(read_sheet(page, sheet_));
    const std::array<Vector2d, 4> corners{Vector2d(90, 70), Vector2d(1340, 160), Vector2d(1250, 980),
                                          Vector2d(140, 900)};
    for (const std::size_t turn : {0U, 1U, 2U, 3U}) {
        std::array<Vector2d, 4> turned;
        for (std::size_t i = 0; i < 4; ++i) turned[i] = corners[(i + turn) % 4];
        const Image photo = photograph(page, turned, 1440, 1080);
        const Image read = read_sheet(photo, sheet_);
        EXPECT_EQ(read.width * view_.height, read.height * view_.width);
        const FloatImage darkness = drawing_darkness(read);
        // Compared at the view's resolution: both darknesses are means over a pixel of the view.
        const double finer = static_cast<double>(read.width) / view_.width;
        const double truth_finer = static_cast<double>(truth.width) / view_.width;
        double sum = 0, most = 0, count = 0;
        for (int y = 60; y < view_.height - 60; ++y)
            for (int x = 60; x < view_.width - 60; ++x) {
                const auto at = [&](const FloatImage& image, double scale) {
                    double mean = 0;
                    const int steps = static_cast<int>(scale);
                    for (int v = 0; v < steps; ++v)
                        for (int u = 0; u < steps; ++u)
                            mean += static_cast<double>(
                                image.pixel(static_cast<int>(x * scale) + u, static_cast<int>(y * scale) + v)[0]);
                    return mean / (steps * steps);
                };
                const double difference = std::abs(at(darkness, finer) - at(truth, truth_finer));
                sum += difference, most = std::max(most, difference), ++count;
            }
        EXPECT_LT(sum / count, 0.06) << "turned by " << turn;
        EXPECT_LT(most, 0.5);
    }
}

TEST_F(PrintedSheet, TheViewInBlueIsNotRead) {
    Image page = page_;
    draw_lines(page, sheet_);
    const Image read = read_sheet(page, sheet_);
    const FloatImage darkness = drawing_darkness(read);
    const double finer = static_cast<double>(read.width) / view_.width;
    const auto at = [&](double x, double y) {
        return darkness.pixel(static_cast<int>(finer * x), static_cast<int>(finer * y))[0];
    };
    // Between two lines, inside of the ball and outside.
    for (double x = 60; x < view_.width - 60; ++x) {
        const double along = std::fmod(x + 0.5 * 110, 10.0);
        if (along < 4 || along > 8) continue;
        EXPECT_LT(at(x, 110), 0.09f) << x;
    }
}

TEST_F(PrintedSheet, WithoutItsMarksASheetIsRefused) {
    Image page = page_;
    const Vector2d& mark = sheet_.marks[2];
    for (int y = static_cast<int>(mark.y()) - 60; y < static_cast<int>(mark.y()) + 60; ++y)
        for (int x = static_cast<int>(mark.x()) - 60; x < static_cast<int>(mark.x()) + 60; ++x)
            std::ranges::fill(page.pixel(x, y), std::uint8_t{255});
    EXPECT_FALSE(find_marks(page));
    EXPECT_THROW(read_sheet(page, sheet_), DataError);
}

TEST(InkColor, ColoredLinesAreLeftOutOfADrawingInBlack) {
    Image drawing(120, 90, 3, 250);
    for (int y = 10; y < 80; ++y)
        for (const int x : {30, 31, 70, 71}) {
            std::ranges::fill(drawing.pixel(x, y), std::uint8_t{25});
            const std::array<std::uint8_t, 3> blue{70, 110, 240};
            std::ranges::copy(blue, drawing.pixel(x + 20, y).begin());
        }
    const FloatImage darkness = drawing_darkness(drawing);
    EXPECT_GT(darkness.pixel(30, 40)[0], 0.85f);
    EXPECT_LT(darkness.pixel(50, 40)[0], 0.08f);
    // Alone, they are the drawing.
    for (int y = 10; y < 80; ++y)
        for (const int x : {30, 31, 70, 71}) std::ranges::fill(drawing.pixel(x, y), std::uint8_t{250});
    EXPECT_GT(drawing_darkness(drawing).pixel(50, 40)[0], 0.4f);
}

TEST(PlaneMap, TakesFourPlacesToFourOthers) {
    const std::array<Vector2d, 4> from{Vector2d(0, 0), Vector2d(4, 1), Vector2d(5, 6), Vector2d(-1, 4)};
    const std::array<Vector2d, 4> to{Vector2d(10, 3), Vector2d(2, 8), Vector2d(-3, 1), Vector2d(4, -5)};
    const PlaneMap map(from, to);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((map.apply(from[i]) - to[i]).norm(), 1e-9);
    // Lines stay lines.
    const Vector2d a = map.apply({1, 1}), b = map.apply({2, 2}), c = map.apply({3, 3});
    EXPECT_NEAR((b - a).x() * (c - a).y(), (b - a).y() * (c - a).x(), 1e-9);
}

}  // namespace
}  // namespace exemplar
