#include "host/labeling/painting/painted_labels.h"

#include <gtest/gtest.h>

#include <array>

#include "host/core/errors.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

std::vector<std::int32_t> labels_of(const PaintedLabels& painted) {
    return {painted.labels().begin(), painted.labels().end()};
}

TEST(PaintedLabels, UndoAndRedoGoThroughAllStatesOfRandomEdits) {
    Random random(3);
    PaintedLabels painted(50);
    std::vector<std::vector<std::int32_t>> states{labels_of(painted)};
    for (int step = 0; step < 200; ++step) {
        painted.begin_step();
        const std::size_t parts = 1 + random.index(3);  // a stroke comes in parts
        for (std::size_t part = 0; part < parts; ++part) {
            std::array<std::uint32_t, 8> faces{};
            for (std::uint32_t& face : faces) face = static_cast<std::uint32_t>(random.index(50));
            painted.paint(faces, static_cast<std::int32_t>(random.index(4)) - 1);
        }
        if (labels_of(painted) != states.back()) states.push_back(labels_of(painted));
    }
    for (std::size_t i = states.size(); i-- > 1;) {
        ASSERT_EQ(labels_of(painted), states[i]);
        // Steps that changed faces back and forth may show no difference.
        do ASSERT_TRUE(painted.undo());
        while (labels_of(painted) == states[i]);
    }
    while (painted.undo()) {
    }
    EXPECT_EQ(labels_of(painted), states.front());
    EXPECT_EQ(painted.painted_count(), 0u);
    while (painted.redo()) {
    }
    EXPECT_EQ(labels_of(painted), states.back());
}

TEST(PaintedLabels, PaintingAfterUndoForgetsWhatWasUndone) {
    PaintedLabels painted(3);
    painted.begin_step();
    painted.paint(std::array{0u}, 1);
    painted.begin_step();
    painted.paint(std::array{1u}, 2);
    EXPECT_TRUE(painted.undo());
    EXPECT_TRUE(painted.can_redo());
    painted.begin_step();
    painted.paint(std::array{2u}, 0);
    EXPECT_FALSE(painted.can_redo());
    EXPECT_EQ(labels_of(painted), (std::vector<std::int32_t>{1, -1, 0}));
    EXPECT_TRUE(painted.undo());
    EXPECT_EQ(labels_of(painted), (std::vector<std::int32_t>{1, -1, -1}));
}

TEST(PaintedLabels, AClickBesideTheMeshIsNoStep) {
    PaintedLabels painted(3);
    painted.begin_step();
    painted.paint(std::array{0u}, 1);
    for (int click = 0; click < 3; ++click) {
        painted.begin_step();
        painted.paint({}, 2);
    }
    EXPECT_TRUE(painted.undo());
    EXPECT_EQ(painted.painted_count(), 0u);
    EXPECT_FALSE(painted.undo());
    EXPECT_TRUE(painted.redo());
    EXPECT_EQ(painted.painted_count(), 1u);
}

TEST(PaintedLabels, StartsWithKnownLabels) {
    PaintedLabels painted(3);
    EXPECT_THROW(painted.start_with(std::array{1}), UsageError);
    painted.start_with(std::array{1, -1, 0});
    EXPECT_EQ(painted.painted_count(), 2u);
    EXPECT_FALSE(painted.can_undo());
}

}  // namespace
}  // namespace exemplar
