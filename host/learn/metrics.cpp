#include "host/learn/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "host/core/errors.h"

namespace exemplar {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

/// Throws unless there are as many areas, and the truths are classes or -1.
void check_items(std::span<const std::int32_t> truth, std::span<const float> areas, std::size_t classes) {
    if (areas.size() != truth.size()) {
        throw UsageError("there are " + std::to_string(areas.size()) + " areas for " + std::to_string(truth.size()) +
                         " items; give one each");
    }
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (truth[i] >= -1 && truth[i] < static_cast<std::int32_t>(classes)) continue;
        throw UsageError("item " + std::to_string(i) + " has the label " + std::to_string(truth[i]) +
                         ", but there are " + std::to_string(classes) + " labels");
    }
}

}  // namespace

ConfusionMatrix confusion_matrix(std::span<const std::int32_t> truth, std::span<const std::int32_t> predicted,
                                 std::span<const float> areas, std::size_t classes) {
    check_items(truth, areas, classes);
    if (predicted.size() != truth.size()) {
        throw UsageError("there are " + std::to_string(predicted.size()) + " predictions for " +
                         std::to_string(truth.size()) + " items; give one each");
    }
    ConfusionMatrix out{classes, std::vector<double>(classes * (classes + 1)), std::vector<std::size_t>(classes)};
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (truth[i] < 0) continue;
        const auto row = static_cast<std::size_t>(truth[i]);
        const std::size_t column = predicted[i] < 0 ? classes : std::min<std::size_t>(predicted[i], classes);
        out.area[row * (classes + 1) + column] += static_cast<double>(areas[i]);
        ++out.counts[row];
    }
    return out;
}

double recognition_rate(const ConfusionMatrix& confusion) {
    double right = 0.0, all = 0.0;
    for (std::size_t c = 0; c < confusion.classes; ++c) right += confusion.at(c, c);
    for (const double area : confusion.area) all += area;
    return all > 0.0 ? right / all : k_nan;
}

double segment_weighted_accuracy(const ConfusionMatrix& confusion) {
    double sum = 0.0, present = 0.0;
    for (std::size_t c = 0; c < confusion.classes; ++c) {
        if (confusion.counts[c] == 0) continue;
        double all = 0.0;
        for (std::size_t p = 0; p <= confusion.classes; ++p) all += confusion.at(c, p);
        sum += all > 0.0 ? confusion.at(c, c) / all : 0.0;
        present += 1.0;
    }
    return present > 0.0 ? sum / present : k_nan;
}

}  // namespace exemplar
