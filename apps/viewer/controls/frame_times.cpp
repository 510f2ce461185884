#include "apps/viewer/controls/frame_times.h"

#include <algorithm>
#include <numeric>

namespace exemplar {

void FrameTimes::begin_frame() {
    newest_ = (newest_ + 1) % k_frames;
    count_ = std::min(count_ + 1, k_frames);
    // Kernels that have not run for as long as the ring remembers are forgotten.
    for (auto& [name, series] : series_) series[newest_] = 0;
    std::erase_if(series_, [](const auto& entry) {
        return std::ranges::all_of(entry.second, [](float milliseconds) { return milliseconds == 0; });
    });
}

void FrameTimes::add(std::string_view kernel, double milliseconds) {
    auto series = series_.find(kernel);
    if (series == series_.end()) series = series_.emplace(std::string(kernel), Series{}).first;
    series->second[newest_] += static_cast<float>(milliseconds);
}

std::vector<std::string> FrameTimes::names() const {
    std::vector<std::pair<float, std::string>> ordered;
    for (const auto& [name, series] : series_) ordered.emplace_back(-average(name), name);
    std::ranges::sort(ordered);
    std::vector<std::string> names;
    names.reserve(ordered.size());
    for (const auto& [average, name] : ordered) names.push_back(name);
    return names;
}

float FrameTimes::at(const std::string& name, std::size_t age) const {
    const auto series = series_.find(name);
    return series == series_.end() || age >= count_ ? 0 : series->second[place(age)];
}

float FrameTimes::average(const std::string& name) const {
    const auto series = series_.find(name);
    if (series == series_.end() || count_ == 0) return 0;
    return std::accumulate(series->second.begin(), series->second.end(), 0.0f) / static_cast<float>(count_);
}

float FrameTimes::total(std::size_t age) const {
    float sum = 0;
    for (const auto& [name, series] : series_) sum += at(name, age);
    return sum;
}

float FrameTimes::average_total() const {
    float sum = 0;
    for (const auto& [name, series] : series_) sum += average(name);
    return sum;
}

}  // namespace exemplar
