#include "host/labeling/painting/shape_order.h"

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/statistics.h"

namespace exemplar {
namespace {

constexpr std::size_t k_neighbors = 3;  ///< the width of the kernel is the distance to the third nearest shape

/// Scales each value of the descriptors to mean 0 and deviation 1 over the shapes; values that do not vary become 0.
std::vector<std::vector<float>> standardized(std::span<const ShapeDescriptor> shapes) {
    std::vector<std::vector<float>> result(shapes.size());
    for (std::size_t s = 0; s < shapes.size(); ++s) {
        if (shapes[s].values.size() != shapes.front().values.size())
            throw UsageError("the descriptors of these shapes are of different features");
        result[s] = shapes[s].values;
    }
    const auto count = static_cast<double>(shapes.size());
    for (std::size_t v = 0; !shapes.empty() && v < shapes.front().values.size(); ++v) {
        double sum = 0, squares = 0;
        for (const auto& shape : result) {
            const auto value = static_cast<double>(shape[v]);
            sum += value, squares += value * value;
        }
        const double mean = sum / count, variance = squares / count - mean * mean;
        const double inverse = variance > 1e-12 * (1e-12 + mean * mean) ? 1 / std::sqrt(variance) : 0;
        for (auto& shape : result) shape[v] = static_cast<float>((static_cast<double>(shape[v]) - mean) * inverse);
    }
    return result;
}

float squared_distance(const std::vector<float>& a, const std::vector<float>& b) {
    float sum = 0;
    for (std::size_t v = 0; v < a.size(); ++v) sum += (a[v] - b[v]) * (a[v] - b[v]);
    return sum;
}

/// Returns the median, over the shapes, of the squared distance to the third nearest other shape; 1 if all are alike.
float kernel_width(std::span<const float> squared, std::size_t size) {
    std::vector<float> nearest;
    nearest.reserve(size);
    for (std::size_t a = 0; a < size && size > 1; ++a) {
        std::vector<float> row(squared.begin() + static_cast<std::ptrdiff_t>(a * size),
                               squared.begin() + static_cast<std::ptrdiff_t>((a + 1) * size));
        const std::size_t rank = std::min(k_neighbors, size - 1);  // at rank 0 is the shape itself
        std::nth_element(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(rank), row.end());
        nearest.push_back(row[rank]);
    }
    const float width = nearest.empty() ? 0 : upper_median(nearest);
    return width > 0 ? width : 1;
}

}  // namespace

ShapeLikeness::ShapeLikeness(std::span<const ShapeDescriptor> shapes) : size_(shapes.size()), value_(size_ * size_, 0) {
    const auto values = standardized(shapes);
    for (std::size_t a = 0; a < size_; ++a)
        for (std::size_t b = 0; b < a; ++b)
            value_[a * size_ + b] = value_[b * size_ + a] = squared_distance(values[a], values[b]);
    const float width = kernel_width(value_, size_);
    for (float& value : value_) value = std::exp(-value / (2 * width));
}

double expected_seconds(float uncertainty, std::size_t labels, const PersonCosts& costs) {
    constexpr double k_strokes_a_label = 2;
    const double strokes = k_strokes_a_label * static_cast<double>(labels) * static_cast<double>(uncertainty);
    return costs.open + costs.stroke * strokes + costs.verify;
}

std::vector<std::size_t> order_by_gain(const ShapeLikeness& likeness, std::span<const float> uncertainty,
                                       std::size_t labels, const PersonCosts& costs) {
    if (uncertainty.size() != likeness.size()) throw UsageError("uncertainties and shapes differ in number");
    std::vector<float> left(uncertainty.begin(), uncertainty.end());
    std::vector<bool> waiting(left.size());
    std::size_t count = 0;
    for (std::size_t s = 0; s < left.size(); ++s) count += (waiting[s] = left[s] > 0) ? 1 : 0;
    std::vector<std::size_t> order;
    order.reserve(count);
    while (order.size() < count) {
        std::size_t best = 0;
        double most = -1;
        for (std::size_t s = 0; s < left.size(); ++s) {
            if (!waiting[s]) continue;
            float gain = 0;
            for (std::size_t other = 0; other < left.size(); ++other) gain += left[other] * likeness(s, other);
            const double rate = static_cast<double>(gain) / expected_seconds(uncertainty[s], labels, costs);
            if (rate > most) most = rate, best = s;
        }
        order.push_back(best);
        waiting[best] = false;
        for (std::size_t other = 0; other < left.size(); ++other) left[other] *= 1 - likeness(best, other);
    }
    return order;
}

}  // namespace exemplar
