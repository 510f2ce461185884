#include "host/hatching/style/cut_learning.h"

#include <gtest/gtest.h>

#include "host/core/random.h"
#include "tests/hatching/features/host_tools.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// A ball whose left half has label 0 and whose right half has label 1. Boundaries cannot be told: P(e) is a half.
class HalvedBall {
  public:
    HalvedBall() {
        drawing_.width = drawing_.height = k_side;
        for (const std::uint32_t pixel : pixels_.pixels().pixel) {
            rows_.push_back(static_cast<std::uint32_t>(rows_.size()));
            labels_.push_back(pixel % k_side < k_side / 2 ? 0 : 1);
        }
    }

    /// Returns the probabilities of a classifier that is sure, and wrong at this share of the pixels.
    std::vector<float> probabilities(double wrong) const {
        Random random(3);
        std::vector<float> out;
        for (const std::int32_t label : labels_) {
            const float of_one = (label == 1) != (random.uniform() < wrong) ? 0.8f : 0.2f;
            out.insert(out.end(), {1 - of_one, of_one});
        }
        return out;
    }

    struct Learned {
        PixelCrfParameters parameters;
        double wrong;  ///< share of pixels
    };
    Learned learn(double noise) {
        const HatchingExample view{pixels_, drawing_};
        const HatchingExamples views(std::span(&view, 1));
        CpuStumpScorer scorer;
        const ExampleFeatures features(views, scorer);
        ExampleCuts cuts(views, features, std::vector<float>(views.size(), 0.5f));
        const std::vector<float> sure = probabilities(noise);
        const PixelCrfParameters parameters = cuts.learn({sure, 2, rows_, labels_}, [] {});
        const std::vector<std::int32_t> found = cuts.solve(sure, 2, parameters);
        double wrong = 0;
        for (std::size_t i = 0; i < found.size(); ++i) wrong += found[i] != labels_[i] ? 1 : 0;
        return {parameters, wrong / static_cast<double>(found.size())};
    }

  private:
    static constexpr int k_side = 60;
    HatchingSurface surface_ = measure_surface(shapes::icosphere(2, 1));
    HatchingView view_{fit_camera(surface_.mesh, Vec3::UnitZ(), 1, {.vertical_fov = 0}), Vec3::UnitZ(), k_side, k_side};
    HostTools host_;
    PixelFeatures pixels_{surface_, view_, host_.tools};
    DrawingProperties drawing_;
    std::vector<std::uint32_t> rows_;
    std::vector<std::int32_t> labels_;
};

// A cut that is stronger than it has to be rounds corners off.
TEST(ExampleCuts, LeaveWhatIsRightAlone) {
    const HalvedBall::Learned learned = HalvedBall().learn(0);
    EXPECT_EQ(learned.parameters, (PixelCrfParameters{0.3f, -0.35f}));
    EXPECT_EQ(learned.wrong, 0);
}

TEST(ExampleCuts, AreAsStrongAsTheNoiseAsksFor) {
    HalvedBall ball;
    const HalvedBall::Learned clean = ball.learn(0), noisy = ball.learn(0.2);
    EXPECT_GT(noisy.parameters.strength * -noisy.parameters.offset,
              clean.parameters.strength * -clean.parameters.offset);
    EXPECT_LT(noisy.wrong, 0.05);
}

}  // namespace
}  // namespace exemplar
