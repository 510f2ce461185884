#include "host/hatching/tracing/drawing_filters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/core/parallel.h"

namespace exemplar {
namespace {

constexpr int k_far = std::numeric_limits<int>::max() / 4;

std::vector<float> gaussian_weights(float sigma) {
    const int reach = std::max(1, static_cast<int>(std::ceil(3 * sigma)));
    std::vector<float> weights;
    float sum = 0;
    for (int k = -reach; k <= reach; ++k) {
        const float x = static_cast<float>(k) / sigma;
        weights.push_back(std::exp(-0.5f * x * x));
        sum += weights.back();
    }
    for (float& w : weights) w /= sum;
    return weights;
}

/// Weights of the derivative of the Gaussian, scaled such that a ramp gets its slope.
std::vector<float> derivative_weights(float sigma) {
    std::vector<float> weights = gaussian_weights(sigma);
    const int reach = static_cast<int>(weights.size() / 2);
    float slope = 0;
    for (int k = -reach; k <= reach; ++k) {
        weights[k + reach] *= static_cast<float>(k);
        slope += static_cast<float>(k) * weights[k + reach];
    }
    for (float& w : weights) w /= slope;
    return weights;
}

void filter_row(const float* row, int width, std::span<const float> weights, std::vector<float>& padded, float* out) {
    const int reach = static_cast<int>(weights.size() / 2);
    padded.resize(static_cast<std::size_t>(width) + 2 * static_cast<std::size_t>(reach));
    for (int x = -reach; x < width + reach; ++x) padded[x + reach] = row[std::clamp(x, 0, width - 1)];
    std::fill_n(out, width, 0.0f);
    for (std::size_t k = 0; k < weights.size(); ++k)
        for (int x = 0; x < width; ++x) out[x] += weights[k] * padded[static_cast<std::size_t>(x) + k];
}

void filter_across_rows(const FloatImage& image, int y, std::span<const float> weights, float* out) {
    const int reach = static_cast<int>(weights.size() / 2);
    std::fill_n(out, image.width, 0.0f);
    for (int k = -reach; k <= reach; ++k) {
        const int from = std::clamp(y + k, 0, image.height - 1);
        const float* row = image.data.data() + static_cast<std::size_t>(from) * static_cast<std::size_t>(image.width);
        for (int x = 0; x < image.width; ++x) out[x] += weights[k + reach] * row[x];
    }
}

/// Correlation with weights along rows and weights across them.
FloatImage filtered(const FloatImage& image, std::span<const float> along_rows, std::span<const float> across_rows) {
    FloatImage along(image.width, image.height, 1), result(image.width, image.height, 1);
    const std::size_t width = static_cast<std::size_t>(image.width), rows = static_cast<std::size_t>(image.height);
    parallel_ranges(rows, 16, [&](std::size_t begin, std::size_t end) {
        std::vector<float> padded;
        for (std::size_t y = begin; y != end; ++y)
            filter_row(image.data.data() + y * width, image.width, along_rows, padded, along.data.data() + y * width);
    });
    parallel_for(
        rows,
        [&](std::size_t y) {
            filter_across_rows(along, static_cast<int>(y), across_rows, result.data.data() + y * width);
        },
        16);
    return result;
}

/// Returns, for each pixel, the row of the nearest site in its column, or k_far if the column has none.
std::vector<int> nearest_in_columns(int width, int height, std::span<const std::uint8_t> is_site) {
    std::vector<int> row(is_site.size(), k_far);
    const auto sweep = [&](int y, int before) {
        for (int x = 0; x < width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * width + x;
            if (is_site[i]) {
                row[i] = y;
            } else if (before >= 0 && before < height) {
                const int other = row[static_cast<std::size_t>(before) * width + x];
                if (std::abs(other - y) < std::abs(row[i] - y)) row[i] = other;
            }
        }
    };
    for (int y = 0; y < height; ++y) sweep(y, y - 1);
    for (int y = height - 1; y >= 0; --y) sweep(y, y + 1);
    return row;
}

/// The lower envelope of the parabolas (x - c)^2 + g(c)^2 of one row's columns: which column wins from where on.
struct Envelope {
    std::vector<int> column, from;
};

/// Returns the first x from which the parabola of column `b` is lower than that of `a`; a < b.
int takes_over(int a, std::int64_t ga, int b, std::int64_t gb) {
    const std::int64_t above =
        (static_cast<std::int64_t>(b) * b - static_cast<std::int64_t>(a) * a) + gb * gb - ga * ga;
    const std::int64_t below = 2 * (static_cast<std::int64_t>(b) - a);
    return static_cast<int>((above >= 0 ? above / below : -((-above + below - 1) / below)) + 1);
}

void nearest_in_row(int y, int width, std::span<const int> row, Envelope& envelope, std::int32_t* site) {
    const auto gap = [&](int x) { return static_cast<std::int64_t>(row[x]) - y; };
    envelope.column.clear();
    envelope.from.clear();
    for (int x = 0; x < width; ++x) {
        if (row[x] == k_far) continue;
        int from = 0;
        while (!envelope.column.empty()) {
            from = takes_over(envelope.column.back(), gap(envelope.column.back()), x, gap(x));
            if (from > envelope.from.back()) break;
            envelope.column.pop_back();
            envelope.from.pop_back();
            from = 0;
        }
        if (from >= width) continue;
        envelope.column.push_back(x);
        envelope.from.push_back(std::max(from, 0));
    }
    for (std::size_t k = 0; k < envelope.column.size(); ++k) {
        const int c = envelope.column[k], end = k + 1 < envelope.column.size() ? envelope.from[k + 1] : width;
        for (int x = envelope.from[k]; x < end; ++x) site[x] = static_cast<std::int32_t>(row[c]) * width + c;
    }
}

}  // namespace

FloatImage gaussian_blur(const FloatImage& image, float sigma) {
    if (sigma <= 0 || image.data.empty()) return image;
    const std::vector<float> weights = gaussian_weights(sigma);
    return filtered(image, weights, weights);
}

ImageGradient gaussian_gradient(const FloatImage& image, float sigma) {
    if (image.data.empty()) return {image, image};
    const std::vector<float> weights = gaussian_weights(sigma), derivative = derivative_weights(sigma);
    return {filtered(image, derivative, weights), filtered(image, weights, derivative)};
}

std::vector<std::int32_t> nearest_sites(int width, int height, std::span<const std::uint8_t> is_site) {
    std::vector<std::int32_t> site(is_site.size(), k_no_site);
    if (is_site.empty()) return site;
    const std::vector<int> row = nearest_in_columns(width, height, is_site);
    parallel_ranges(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
        Envelope envelope;
        for (std::size_t y = begin; y != end; ++y) {
            const std::size_t start = y * static_cast<std::size_t>(width);
            nearest_in_row(static_cast<int>(y), width, std::span(row).subspan(start, static_cast<std::size_t>(width)),
                           envelope, site.data() + start);
        }
    });
    return site;
}

float pixel_distance(std::int32_t first, std::int32_t second, int width) {
    const int dx = first % width - second % width, dy = first / width - second / width;
    return std::sqrt(static_cast<float>(dx * dx + dy * dy));
}

}  // namespace exemplar
