#include "host/hatching/style/pixel_crf.h"

#include <algorithm>
#include <cmath>

#include "host/core/interrupt.h"

namespace exemplar {
namespace {

/// Returns the pairs of covered pixels that touch at a side or a corner, each once.
std::vector<std::array<std::uint32_t, 2>> neighbor_pairs(const CoveredPixels& pixels, int width) {
    constexpr std::array<std::array<int, 2>, 4> k_steps{{{1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
    const int height = width > 0 ? static_cast<int>(pixels.row.size()) / width : 0;
    std::vector<std::array<std::uint32_t, 2>> pairs;
    for (std::uint32_t i = 0; i < pixels.pixel.size(); ++i) {
        const int x = static_cast<int>(pixels.pixel[i]) % width, y = static_cast<int>(pixels.pixel[i]) / width;
        for (const auto& [dx, dy] : k_steps) {
            if (x + dx < 0 || x + dx >= width || y + dy >= height) continue;
            const std::int32_t j = pixels.row[static_cast<std::size_t>(y + dy) * static_cast<std::size_t>(width) +
                                              static_cast<std::size_t>(x + dx)];
            if (j >= 0) pairs.push_back({i, static_cast<std::uint32_t>(j)});
        }
    }
    return pairs;
}

}  // namespace

PixelCrf::PixelCrf(const CoveredPixels& pixels, int width, std::span<const float> boundary)
    : edges_(neighbor_pairs(pixels, width)), expansion_(pixels.pixel.size(), edges_) {
    evidence_.reserve(edges_.size());
    for (const auto& [i, j] : edges_) evidence_.push_back(std::log(std::max(boundary[i] + boundary[j], 1e-6f)));
}

std::vector<std::int32_t> PixelCrf::solve(std::span<const float> probabilities, std::size_t classes,
                                          const PixelCrfParameters& parameters) {
    check_interrupt();
    std::vector<float> unary(probabilities.size());
    for (std::size_t k = 0; k < unary.size(); ++k) unary[k] = -std::log(std::max(probabilities[k], 1e-6f));
    std::vector<double> weight(edges_.size());
    for (std::size_t e = 0; e < weight.size(); ++e) {
        const float cost = -parameters.strength * (evidence_[e] + parameters.offset);
        weight[e] = static_cast<double>(std::max(cost, 0.0f));
    }
    std::vector<double> potts(classes * classes, 1.0);
    for (std::size_t c = 0; c < classes; ++c) potts[c * classes + c] = 0;
    constexpr std::size_t k_sweeps = 4;
    return expansion_.solve({unary, weight, potts}, classes, k_sweeps).labels;
}

}  // namespace exemplar
