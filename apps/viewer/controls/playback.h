#pragma once

#include <cstddef>

namespace exemplar {

/// A clock over the frames of a clip. Without frames, or with one, it stands still.
class Playback {
  public:
    Playback() = default;
    /// Starts at the first frame; speed, looping and whether it plays stay.
    void set_clip(std::size_t frames, double frames_per_second);

    std::size_t frame_count() const { return frames_; }
    double frames_per_second() const { return frames_per_second_; }
    /// The frame to show: below frame_count(), or 0.
    std::size_t frame() const;
    bool playing() const { return playing_; }
    bool loops() const { return loops_; }
    double speed() const { return speed_; }

    /// Plays on; from the start if it stands at the end and does not loop.
    void play();
    void pause() { playing_ = false; }
    void toggle() { playing_ ? pause() : play(); }
    void set_loops(bool loops) { loops_ = loops; }
    /// In [0.05, 8]: how much faster than the clip's own rate.
    void set_speed(double speed);
    /// Pauses at a frame, or the last if there are not as many.
    void scrub(std::size_t frame);
    /// Pauses so many frames on; around the ends if it loops.
    void step(int frames);
    /// Lets so many seconds go by. Returns whether another frame is to be shown.
    bool advance(double seconds);

  private:
    std::size_t frames_ = 0;
    double frames_per_second_ = 30, speed_ = 1;
    double time_ = 0;  // in frames, below frames_
    bool playing_ = false, loops_ = true;
};

}  // namespace exemplar
