#include "apps/viewer/controls/frame_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace exemplar {
namespace {

TEST(FrameTimes, AddUpWithinAFrameAndOverKernels) {
    FrameTimes times;
    times.begin_frame();
    times.add("pose", 1);
    times.add("pose", 2);
    times.add("normals", 4);
    EXPECT_FLOAT_EQ(times.at("pose", 0), 3);
    EXPECT_FLOAT_EQ(times.total(0), 7);
    EXPECT_FLOAT_EQ(times.average_total(), 7);
}

TEST(FrameTimes, RememberFramesByAge) {
    FrameTimes times;
    for (int i = 1; i <= 300; ++i) {
        times.begin_frame();
        times.add("pose", i);
    }
    EXPECT_FLOAT_EQ(times.at("pose", 0), 300);
    EXPECT_FLOAT_EQ(times.at("pose", 119), 181);
    EXPECT_FLOAT_EQ(times.at("pose", 120), 0);
    EXPECT_FLOAT_EQ(times.average("pose"), 240.5f);
}

TEST(FrameTimes, AveragesCountFramesThatWere) {
    FrameTimes times;
    EXPECT_FLOAT_EQ(times.average_total(), 0);
    times.begin_frame();
    times.add("pose", 2);
    times.begin_frame();
    EXPECT_FLOAT_EQ(times.average("pose"), 1);
    EXPECT_FLOAT_EQ(times.at("other", 0), 0);
}

TEST(FrameTimes, NameTheSlowestFirstAndForgetWhatHasEnded) {
    FrameTimes times;
    times.begin_frame();
    times.add("once", 9);
    for (int i = 0; i < 10; ++i) {
        times.begin_frame();
        times.add("fast", 1);
        times.add("slow", 5);
    }
    EXPECT_THAT(times.names(), ::testing::ElementsAre("slow", "fast", "once"));
    for (std::size_t i = 0; i < FrameTimes::k_frames; ++i) {
        times.begin_frame();
        times.add("fast", 1);
    }
    EXPECT_THAT(times.names(), ::testing::ElementsAre("fast"));
}

}  // namespace
}  // namespace exemplar
