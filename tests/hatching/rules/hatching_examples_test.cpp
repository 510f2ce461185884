#include "host/hatching/rules/hatching_examples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/core/errors.h"
#include "tests/hatching/features/host_tools.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// The pixels of a sphere in views of different sizes, and drawings of these sizes.
class TwoViews {
  public:
    TwoViews() {
        add(Vec3(1, 2, 3), 40, 30);
        add(Vec3(-3, 1, 0), 24, 36);
    }
    std::vector<HatchingExample> examples() const { return {{*pixels_[0], drawings_[0]}, {*pixels_[1], drawings_[1]}}; }
    PixelFeatures& pixels(std::size_t view) const { return *pixels_[view]; }

  private:
    void add(const Vec3& from, int width, int height) {
        const HatchingView view{fit_camera(surface_.mesh, from, static_cast<float>(width) / static_cast<float>(height),
                                           {.vertical_fov = 0}),
                                Vec3(1, 2, 2) / 3, width, height};
        views_.push_back(std::make_unique<HatchingView>(view));
        pixels_.push_back(std::make_unique<PixelFeatures>(surface_, *views_.back(), host_.tools));
        drawings_.emplace_back();
        drawings_.back().width = width;
        drawings_.back().height = height;
    }

    HatchingSurface surface_ = measure_surface(shapes::icosphere(2, 1));
    HostTools host_;
    std::vector<std::unique_ptr<HatchingView>> views_;
    std::vector<std::unique_ptr<PixelFeatures>> pixels_;
    std::vector<DrawingProperties> drawings_;
};

TEST(HatchingExamples, NumbersThePixelsOfAllViews) {
    const TwoViews views;
    const HatchingExamples all(views.examples());
    ASSERT_EQ(all.size(), views.pixels(0).size() + views.pixels(1).size());
    std::uint32_t row = 0;
    for (std::size_t view = 0; view < 2; ++view) {
        EXPECT_EQ(all.first_row(view), row);
        for (const std::uint32_t pixel : views.pixels(view).pixels().pixel) {
            EXPECT_EQ(all.view_of(row), view);
            EXPECT_EQ(all.pixel_of(row), pixel);
            EXPECT_EQ(all.drawing_of(row).width, views.pixels(view).view().width);
            ++row;
        }
    }
}

// Strokes within a few spacings are neighbors, rectangles hold out what is near: no pixel may be near one of another
// view.
TEST(HatchingExamples, ViewsLieFarApart) {
    const TwoViews views;
    const HatchingExamples all(views.examples());
    int largest_x = 0;
    for (std::uint32_t row = 0; row < all.size(); ++row) {
        const auto [x, y] = all.place_of(row);
        const auto width = static_cast<std::uint32_t>(all.drawing_of(row).width);
        EXPECT_EQ(y, all.pixel_of(row) / width);
        if (all.view_of(row) == 0) {
            EXPECT_EQ(x, all.pixel_of(row) % width);
            largest_x = std::max<int>(largest_x, x);
        } else {
            EXPECT_GT(x, largest_x + 200);
        }
    }
}

TEST(HatchingExamples, RowsHaveTheFeaturesOfTheirView) {
    const TwoViews views;
    const HatchingExamples all(views.examples());
    const std::uint32_t second = all.first_row(1);
    const std::vector<std::uint32_t> rows{second + 5, 3, second, 0, second + 90}, which{0, 91, 210, 290};
    const FeatureMatrix features = all.scalars(which, rows);
    const OrientationFields fields = all.orientations(rows);
    ASSERT_EQ(features.cols(), which.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::size_t view = rows[i] < second ? 0 : 1;
        const std::vector<std::uint32_t> own{rows[i] - (view == 0 ? 0 : second)};
        const FeatureMatrix expected = views.pixels(view).scalars(which, own);
        for (std::size_t k = 0; k < which.size(); ++k)
            EXPECT_EQ(features.column(k)[i], expected.column(k)[0]) << i << " " << k;
        const OrientationFields expected_fields = views.pixels(view).orientations(own);
        for (std::size_t k = 0; k < k_orientation_fields; ++k)
            EXPECT_EQ(fields.field(k)[i], expected_fields.field(k)[0]) << i << " " << k;
    }
}

TEST(HatchingExamples, PartsAreThoseOfAllViews) {
    const TwoViews views;
    const std::size_t faces = views.pixels(0).surface().mesh.face_count();
    views.pixels(0).set_labels({{"head", "body"}, std::vector<std::int32_t>(faces, 1)});
    EXPECT_THAT(HatchingExamples(views.examples()).parts(), testing::IsEmpty());  // the other has none
    views.pixels(1).set_labels({{"tail", "head"}, std::vector<std::int32_t>(faces, 1)});
    const HatchingExamples all(views.examples());
    EXPECT_THAT(all.parts(), testing::ElementsAre("head", "body", "tail"));
    ASSERT_EQ(all.scalar_count(), k_pixel_features + 3);
    const std::vector<std::uint32_t> rows{7, all.first_row(1) + 7}, which{k_pixel_features, k_pixel_features + 1};
    const FeatureMatrix features = all.scalars(which, rows);
    EXPECT_THAT(features.names, testing::ElementsAre("part.head", "part.body"));
    EXPECT_THAT(features.column(0), testing::ElementsAre(0.0f, 1.0f));
    EXPECT_THAT(features.column(1), testing::ElementsAre(1.0f, 0.0f));
}

TEST(HatchingExamples, RefusesDrawingsOfAnotherSize) {
    const TwoViews views;
    DrawingProperties other;
    other.width = 40;
    other.height = 31;
    const std::vector<HatchingExample> wrong{{views.pixels(0), other}};
    EXPECT_THROW(HatchingExamples{wrong}, UsageError);
    EXPECT_THROW(HatchingExamples{std::vector<HatchingExample>{}}, UsageError);
    const HatchingExample one = views.examples()[0];
    EXPECT_THROW(HatchingExamples{std::vector<HatchingExample>(300, one)}, UsageError);
}

}  // namespace
}  // namespace exemplar
