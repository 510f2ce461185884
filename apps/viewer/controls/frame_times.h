#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar {

/// How long the last frames took on the device, by kernel and pass, in milliseconds.
class FrameTimes {
  public:
    static constexpr std::size_t k_frames = 120;
    using Series = std::array<float, k_frames>;  ///< a ring, see at()

    /// Begins the next frame, with zeros.
    void begin_frame();
    /// Of the current frame.
    void add(std::string_view kernel, double milliseconds);

    /// Names, those that take longest on average first.
    std::vector<std::string> names() const;
    /// Of the frame `age` frames before the last; 0 where there was none.
    float at(const std::string& name, std::size_t age) const;
    float average(const std::string& name) const;
    /// All kernels together.
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
