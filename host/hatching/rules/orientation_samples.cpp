#include "host/hatching/rules/orientation_samples.h"

#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

/// Samples by cells of a grid.
class SampleGrid {
  public:
    SampleGrid(const OrientationSamples& samples, float cell) : samples_(samples), cell_(std::max(cell, 1.0f)) {
        std::size_t rows = 1;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            columns_ = std::max(columns_, cell_of(samples.x[i]) + 1);
            rows = std::max(rows, cell_of(samples.y[i]) + 1);
        }
        begin_.assign(columns_ * rows + 1, 0);
        for (std::size_t i = 0; i < samples.size(); ++i) ++begin_[index(i) + 1];
        for (std::size_t c = 0; c + 1 < begin_.size(); ++c) begin_[c + 1] += begin_[c];
        std::vector<std::uint32_t> next = begin_;
        member_.resize(samples.size());
        for (std::size_t i = 0; i < samples.size(); ++i) member_[next[index(i)]++] = static_cast<std::uint32_t>(i);
    }

    template <typename Visit>
    void visit(std::size_t i, float radius, Visit&& visit) const {
        const float x = samples_.x[i], y = samples_.y[i];
        const std::size_t rows = (begin_.size() - 1) / columns_;
        const auto low = [&](float at) { return cell_of(std::max(at - radius, 0.0f)); };
        for (std::size_t cy = low(y); cy <= std::min(cell_of(y + radius), rows - 1); ++cy) {
            for (std::size_t cx = low(x); cx <= std::min(cell_of(x + radius), columns_ - 1); ++cx) {
                for (std::uint32_t k = begin_[cy * columns_ + cx]; k < begin_[cy * columns_ + cx + 1]; ++k) {
                    const float dx = static_cast<float>(samples_.x[member_[k]]) - x;
                    const float dy = static_cast<float>(samples_.y[member_[k]]) - y;
                    if (dx * dx + dy * dy <= radius * radius) visit(member_[k]);
                }
            }
        }
    }

  private:
    std::size_t cell_of(float at) const { return static_cast<std::size_t>(at / cell_); }
    std::size_t index(std::size_t i) const { return cell_of(samples_.y[i]) * columns_ + cell_of(samples_.x[i]); }
    const OrientationSamples& samples_;
    float cell_;
    std::size_t columns_ = 1;
    std::vector<std::uint32_t> begin_, member_;
};

}  // namespace

SampleNeighbors sample_neighbors(const OrientationSamples& samples, float factor) {
    float largest = 1;
    for (const float spacing : samples.spacing) largest = std::max(largest, factor * spacing);
    const SampleGrid grid(samples, largest);
    std::vector<std::vector<std::uint32_t>> found(samples.size());
    parallel_for(
        samples.size(),
        [&](std::size_t i) {
            grid.visit(i, factor * samples.spacing[i], [&](std::uint32_t near) { found[i].push_back(near); });
        },
        256);
    SampleNeighbors out;
    out.begin.push_back(0);
    for (const auto& near : found) {
        out.neighbor.insert(out.neighbor.end(), near.begin(), near.end());
        out.begin.push_back(static_cast<std::uint32_t>(out.neighbor.size()));
    }
    return out;
}

std::vector<std::uint8_t> held_out_rectangles(std::span<const std::uint16_t> x, std::span<const std::uint16_t> y,
                                              std::span<const std::uint32_t> group, double share, std::uint64_t seed,
                                              std::array<double, 2> sides) {
    std::vector<std::uint8_t> held(x.size());
    const std::uint32_t groups = group.empty() ? 0 : *std::ranges::max_element(group) + 1;
    for (std::uint32_t g = 0; g < groups; ++g) {
        std::vector<std::uint32_t> members;
        for (std::uint32_t i = 0; i < group.size(); ++i) {
            if (group[i] == g) members.push_back(i);
        }
        if (members.size() < 20) continue;
        Random random = Random(seed).fork(g);
        // Rectangles around members.
        const auto extent = [&](std::span<const std::uint16_t> at) {
            const auto [low, high] = std::ranges::minmax(members, {}, [&](std::uint32_t i) { return at[i]; });
            return static_cast<double>(at[high] - at[low] + 1);
        };
        const auto range = [&](double size) {
            return sides[1] > 0 ? sides : std::array<double, 2>{size / 20, size / 5};
        };
        const std::array<double, 2> wide = range(extent(x)), high = range(extent(y));
        std::size_t marked = 0;
        while (static_cast<double>(marked) < share * static_cast<double>(members.size())) {
            const std::uint32_t center = members[random.index(members.size())];
            const double half_x = 0.5 * random.uniform(wide[0], wide[1]),
                         half_y = 0.5 * random.uniform(high[0], high[1]);
            for (const std::uint32_t i : members) {
                if (held[i] || std::abs(x[i] - x[center]) > half_x || std::abs(y[i] - y[center]) > half_y) continue;
                held[i] = 1;
                ++marked;
            }
        }
        // If the rectangles cover the whole group, nothing is held out, as nothing would be left to learn from.
        if (marked == members.size())
            for (const std::uint32_t i : members) held[i] = 0;
    }
    return held;
}

}  // namespace exemplar
