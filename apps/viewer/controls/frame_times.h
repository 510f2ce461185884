#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar {

/// Device times of the last frames by kernel and pass, in milliseconds.
class FrameTimes {
  public:
    static constexpr std::size_t k_frames = 120;
    using Series = std::array<float, k_frames>;  ///< a ring buffer, see at()

    /// Begins the next frame, with times of 0.
    void begin_frame();
    /// Adds a time to the current frame.
    void add(std::string_view kernel, double milliseconds);

    /// Returns the names, longest average time first.
    std::vector<std::string> names() const;
    /// Returns the time in the frame `age` frames before the last; 0 if there was none.
    float at(const std::string& name, std::size_t age) const;
    float average(const std::string& name) const;
    /// Sums over all kernels.
    float total(std::size_t age) const;
    float average_total() const;
    std::size_t frame_count() const { return count_; }
    void clear() { *this = {}; }

  private:
    std::size_t place(std::size_t age) const { return (newest_ + k_frames - age) % k_frames; }
    std::map<std::string, Series, std::less<>> series_;
    std::size_t newest_ = 0, count_ = 0;  // count_: up to k_frames
};

}  // namespace exemplar
