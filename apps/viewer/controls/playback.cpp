#include "apps/viewer/controls/playback.h"

#include <algorithm>
#include <cmath>

namespace exemplar {

void Playback::set_clip(std::size_t frames, double frames_per_second) {
    frames_ = frames;
    frames_per_second_ = frames_per_second > 0 ? frames_per_second : 30;
    time_ = 0;
}

std::size_t Playback::frame() const {
    return frames_ == 0 ? 0 : std::min(static_cast<std::size_t>(time_), frames_ - 1);
}

void Playback::play() {
    if (!loops_ && frame() + 1 >= frames_) time_ = 0;
    playing_ = true;
}

void Playback::set_speed(double speed) {
    constexpr double k_slowest = 0.05, k_fastest = 8;
    if (!std::isnan(speed)) speed_ = std::clamp(speed, k_slowest, k_fastest);
}

void Playback::scrub(std::size_t frame) {
    pause();
    time_ = frames_ == 0 ? 0 : static_cast<double>(std::min(frame, frames_ - 1));
}

void Playback::step(int frames) {
    pause();
    if (frames_ == 0) return;
    const auto count = static_cast<long>(frames_);
    long next = static_cast<long>(frame()) + frames;
    next = loops_ ? (next % count + count) % count : std::clamp(next, 0L, count - 1);
    time_ = static_cast<double>(next);
}

bool Playback::advance(double seconds) {
    if (!playing_ || frames_ <= 1 || !(seconds > 0)) return false;
    const std::size_t before = frame();
    const auto count = static_cast<double>(frames_);
    time_ += seconds * frames_per_second_ * speed_;
    // Rounding errors of many steps may leave the time just short of a frame.
    const double nearest = std::round(time_);
    if (std::abs(time_ - nearest) < 1e-9 * count) time_ = nearest;
    if (time_ >= count) {
        playing_ = loops_;
        time_ = loops_ ? std::fmod(time_, count) : count - 1;
    }
    return frame() != before;
}

}  // namespace exemplar
