#include "apps/viewer/controls/playback.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace exemplar {
namespace {

Playback playing(std::size_t frames, double rate) {
    Playback playback;
    playback.set_clip(frames, rate);
    playback.play();
    return playback;
}

TEST(Playback, ShowsAFrameForAsLongAsTheClipDoes) {
    Playback playback = playing(10, 25);
    EXPECT_FALSE(playback.advance(0.039));
    EXPECT_EQ(playback.frame(), 0u);
    EXPECT_TRUE(playback.advance(0.002));
    EXPECT_EQ(playback.frame(), 1u);
}

TEST(Playback, StepsOfAFrameEachShowEveryFrame) {
    Playback playback = playing(1000, 30);
    for (std::size_t i = 1; i < 1000; ++i) {
        playback.advance(1.0 / 30);
        ASSERT_EQ(playback.frame(), i);
    }
}

TEST(Playback, LoopsOrEndsAtTheLastFrame) {
    Playback playback = playing(10, 10);
    playback.advance(1.25);
    EXPECT_EQ(playback.frame(), 2u);
    EXPECT_TRUE(playback.playing());
    playback.set_loops(false);
    playback.advance(100);
    EXPECT_EQ(playback.frame(), 9u);
    EXPECT_FALSE(playback.playing());
    playback.play();
    EXPECT_EQ(playback.frame(), 0u);
}

TEST(Playback, SpeedIsAFactorWithEnds) {
    Playback playback = playing(100, 10);
    playback.set_speed(2);
    playback.advance(1.01);
    EXPECT_EQ(playback.frame(), 20u);
    playback.set_speed(0);
    EXPECT_GT(playback.speed(), 0);
    playback.set_speed(1e9);
    EXPECT_LE(playback.speed(), 8);
    const double speed = playback.speed();
    playback.set_speed(std::nan(""));
    EXPECT_EQ(playback.speed(), speed);
}

TEST(Playback, ScrubbingPausesInsideTheClip) {
    Playback playback = playing(10, 30);
    playback.scrub(4);
    EXPECT_EQ(playback.frame(), 4u);
    EXPECT_FALSE(playback.playing());
    playback.scrub(400);
    EXPECT_EQ(playback.frame(), 9u);
}

TEST(Playback, StepsGoAroundOnlyInLoops) {
    Playback playback = playing(10, 30);
    playback.step(-1);
    EXPECT_EQ(playback.frame(), 9u);
    playback.step(21);
    EXPECT_EQ(playback.frame(), 0u);
    playback.set_loops(false);
    playback.step(-1);
    EXPECT_EQ(playback.frame(), 0u);
    playback.step(50);
    EXPECT_EQ(playback.frame(), 9u);
}

TEST(Playback, WithoutFramesItStandsStill) {
    for (const std::size_t frames : {0u, 1u}) {
        Playback playback = playing(frames, 30);
        EXPECT_FALSE(playback.advance(10));
        playback.step(3);
        playback.scrub(5);
        EXPECT_EQ(playback.frame(), 0u);
    }
}

TEST(Playback, TakesNoNonsenseFromClocksAndClips) {
    Playback playback = playing(10, 0);
    EXPECT_GT(playback.frames_per_second(), 0);
    EXPECT_FALSE(playback.advance(-1));
    EXPECT_FALSE(playback.advance(std::nan("")));
    playback.advance(1e6);
    EXPECT_LT(playback.frame(), 10u);
}

}  // namespace
}  // namespace exemplar
