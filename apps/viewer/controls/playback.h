#pragma once

#include <cstddef>

namespace exemplar {

/// A clock over the frames of a clip. It does not run if there is no frame or only one.
class Playback {
  public:
    Playback() = default;
    /// Sets the clip and goes to the first frame; keeps speed, looping and whether it plays.
    void set_clip(std::size_t frames, double frames_per_second);

    std::size_t frame_count() const { return frames_; }
    double frames_per_second() const { return frames_per_second_; }
    /// The frame to show: below frame_count(), or 0.
    std::size_t frame() const;
    bool playing() const { return playing_; }
    bool loops() const { return loops_; }
    double speed() const { return speed_; }

    /// Starts playing; from the first frame if it is at the end and does not loop.
    void play();
    void pause() { playing_ = false; }
    void toggle() { playing_ ? pause() : play(); }
    void set_loops(bool loops) { loops_ = loops; }
    /// Sets the speed relative to the clip's frame rate, clamped to [0.05, 8].
    void set_speed(double speed);
    /// Pauses at a frame, or at the last one if there are fewer frames.
    void scrub(std::size_t frame);
    /// Pauses `frames` frames further; wraps around the ends if it loops.
    void step(int frames);
    /// Advances the clock. Returns whether the frame has changed.
    bool advance(double seconds);

  private:
    std::size_t frames_ = 0;
    double frames_per_second_ = 30, speed_ = 1;
    double time_ = 0;  // in frames, below frames_
    bool playing_ = false, loops_ = true;
};

}  // namespace exemplar
