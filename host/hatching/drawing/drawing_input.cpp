#include "host/hatching/drawing/drawing_input.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/statistics.h"

namespace exemplar {
FloatImage gray_over_white(const Image& picture) {
    FloatImage gray(picture.width, picture.height, 1);
    const std::size_t channels = static_cast<std::size_t>(picture.channels);
    parallel_for(
        gray.data.size(),
        [&](std::size_t i) {
            const std::uint8_t* p = picture.data.data() + i * channels;
            const auto luma = [&] { return (0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2]) / 255; };
            if (channels == 1)
                gray.data[i] = static_cast<float>(p[0]) / 255;
            else if (channels == 3)
                gray.data[i] = luma();
            else
                gray.data[i] = 1 + (luma() - 1) * static_cast<float>(p[3]) / 255;
        },
        4096);
    return gray;
}

namespace {

constexpr std::size_t k_paper_samples = 60000;  ///< pixels that the paper is fitted to
constexpr int k_fits = 12;                      ///< rounds of fitting and of removing outliers
constexpr float k_min_noise = 0.006f;           ///< of paper: one and a half steps of 8 bits
constexpr float k_darkest_paper = 0.25f;        ///< gray below which nothing counts as paper
constexpr float k_min_ink_darkness = 0.1f;      ///< min darkness of ink
constexpr float k_max_ink_share = 0.85f;        ///< max share of the image
constexpr double k_min_ink_pixels = 4;          ///< pixels

using Terms = Eigen::Matrix<double, 6, 1>;

Terms terms_at(std::size_t i, const FloatImage& gray) {
    const std::size_t width = static_cast<std::size_t>(gray.width);
    const std::size_t row = i / width, column = i % width;
    const double x = 2 * (static_cast<double>(column) + 0.5) / gray.width - 1;
    const double y = 2 * (static_cast<double>(row) + 0.5) / gray.height - 1;
    return (Terms() << 1, x, y, x * x, x * y, y * y).finished();
}

/// Pixels spread over the image, with their gray.
struct PaperSamples {
    std::vector<Terms> terms;
    std::vector<float> gray;
};

PaperSamples sample_paper(const FloatImage& gray) {
    // An odd stride, so that the samples do not all fall on the strokes of one regular hatching.
    const std::size_t stride = gray.data.size() > k_paper_samples ? (gray.data.size() / k_paper_samples) | 1u : 1;
    PaperSamples samples;
    for (std::size_t i = 0; i < gray.data.size(); i += stride) {
        samples.terms.push_back(terms_at(i, gray));
        samples.gray.push_back(gray.data[i]);
    }
    return samples;
}

/// The paper's level as a function of Terms, and its noise (standard deviation).
struct Paper {
    Terms level = Terms::Zero();
    float noise = k_min_noise;
};

/// Estimates noise from the samples lighter than the paper: only the darker side has strokes.
float noise_above(const PaperSamples& samples, const Terms& level, float band) {
    std::vector<float> above;
    for (std::size_t i = 0; i < samples.gray.size(); ++i) {
        const float rest = samples.gray[i] - static_cast<float>(level.dot(samples.terms[i]));
        if (rest >= 0 && rest < band) above.push_back(rest);
    }
    return above.empty() ? k_min_noise : std::max(k_min_noise, 1.4826f * quantile(above, 0.5));
}

/// Fits the level by least squares to the samples within `band` of the previous level.
Terms fit_level(const PaperSamples& samples, const Terms& before, float band) {
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Terms right = Terms::Zero();
    for (std::size_t i = 0; i < samples.gray.size(); ++i) {
        const Terms& t = samples.terms[i];
        if (std::abs(samples.gray[i] - static_cast<float>(before.dot(t))) > band) continue;
        normal += t * t.transpose();
        right += t * static_cast<double>(samples.gray[i]);
    }
    // A little weight on the previous level keeps tiny images, and corners without paper, from extrapolating.
    const double hold = 1e-3 * (1 + normal(0, 0));
    normal.diagonal().array() += hold;
    right += hold * before;
    return normal.ldlt().solve(right);
}

Paper estimate_paper(const FloatImage& gray) {
    const PaperSamples samples = sample_paper(gray);
    Paper paper;
    std::vector<float> values = samples.gray;
    paper.level[0] = static_cast<double>(quantile(values, 0.9));
    float band = 0.2f;
    for (int round = 0; round < k_fits; ++round) {
        paper.level = fit_level(samples, paper.level, band);
        paper.noise = noise_above(samples, paper.level, band);
        band = std::max(3 * paper.noise, 0.7f * band);
    }
    paper.level = fit_level(samples, paper.level, 3 * paper.noise);
    return paper;
}

/// Returns the paper's red, green and blue, from 0 to 1: what most of the light pixels have.
std::array<float, 3> paper_color(const Image& drawing) {
    const auto channels = static_cast<std::size_t>(drawing.channels);
    const std::size_t pixels = drawing.data.size() / channels, stride = pixels / k_paper_samples | 1u;
    std::array<float, 3> color{};
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<float> values;
        for (std::size_t i = 0; i < pixels; i += stride)
            values.push_back(static_cast<float>(drawing.data[i * channels + c]) / 255);
        color[c] = std::max(k_darkest_paper, quantile(values, 0.8));
    }
    return color;
}

/// Returns whether the darkest pixels of a drawing have a color.
bool has_colored_ink(const Image& drawing, const FloatImage& gray) {
    constexpr float k_dark = 0.5f;
    constexpr int k_colored = 48;  // of 255, between the lightest and the darkest channel
    const auto channels = static_cast<std::size_t>(drawing.channels);
    std::size_t dark = 0, colored = 0;
    for (std::size_t i = 0; i < gray.data.size(); ++i) {
        if (gray.data[i] > k_dark) continue;
        const auto [least, most] = std::ranges::minmax(std::span(drawing.data).subspan(i * channels, 3));
        ++dark;
        colored += most - least > k_colored;
    }
    return 2 * colored > dark;
}

/// Returns the gray of each pixel. Where the ink has no color, that is the channel that is lightest beside the paper's,
/// so that colored construction lines and a view that was printed in pale blue vanish, in the light of a lamp, too.
FloatImage ink_gray(const Image& drawing) {
    FloatImage gray = gray_over_white(drawing);
    if (drawing.channels != 3 || has_colored_ink(drawing, gray)) return gray;
    const std::array<float, 3> paper = paper_color(drawing);
    const float white = std::ranges::max(paper);
    for (std::size_t i = 0; i < gray.data.size(); ++i) {
        float lightest = 0;
        for (std::size_t c = 0; c < 3; ++c)
            lightest = std::max(lightest, static_cast<float>(drawing.data[3 * i + c]) / 255 / paper[c]);
        gray.data[i] = white * lightest;
    }
    return gray;
}

void check_ink(const FloatImage& darkness, float noise) {
    const float least = std::max(k_min_ink_darkness, 6 * noise);
    const auto inked = static_cast<double>(
        std::count_if(darkness.data.begin(), darkness.data.end(), [&](float d) { return d > least; }));
    if (inked < k_min_ink_pixels)
        throw DataError(
            fmt::format("the drawing is blank: nothing on its {} x {} pixels is darker than the paper; give "
                        "an image with dark strokes",
                        darkness.width, darkness.height));
    if (inked > k_max_ink_share * static_cast<double>(darkness.data.size()))
        throw DataError(
            fmt::format("{:.0f}% of the drawing is dark, so there is no paper to see strokes on; give dark "
                        "strokes on light paper, not a negative",
                        100 * inked / static_cast<double>(darkness.data.size())));
}

}  // namespace

FloatImage drawing_darkness(const Image& drawing) {
    if (drawing.channels != 1 && drawing.channels != 3 && drawing.channels != 4)
        throw UsageError(fmt::format("a drawing of {} channels; give gray, RGB or RGBA", drawing.channels));
    if (drawing.width <= 0 || drawing.height <= 0) throw UsageError("the drawing has no pixels");
    FloatImage darkness = ink_gray(drawing);
    const Paper paper = estimate_paper(darkness);
    if (paper.level[0] < k_darkest_paper)
        throw DataError(
            "the drawing is dark all over, so there is no paper to see strokes on; give dark strokes on "
            "light paper, not a negative");
    parallel_for(
        darkness.data.size(),
        [&](std::size_t i) {
            const float level = std::max(k_darkest_paper, static_cast<float>(paper.level.dot(terms_at(i, darkness))));
            darkness.data[i] = 1 - darkness.data[i] / level;
        },
        4096);
    check_ink(darkness, paper.noise);
    return darkness;
}

}  // namespace exemplar
