#include "host/labeling/evaluation/learning_curve.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "host/core/errors.h"
#include "host/learn/golden_section.h"

namespace exemplar {
namespace {

/// The best law of a given exponent: linear regression of the error on n^-exponent, with both coefficients >= 0.
PowerLaw law_of_exponent(std::span<const LearningPoint> points, double exponent) {
    const auto count = static_cast<double>(points.size());
    double x = 0, y = 0, xx = 0, xy = 0;
    for (const LearningPoint& point : points) {
        const double power = std::pow(static_cast<double>(point.shapes), -exponent);
        x += power / count, y += point.error / count;
        xx += power * power / count, xy += power * point.error / count;
    }
    const double factor = std::max(0.0, (xy - x * y) / (xx - x * x));
    const double limit = y - factor * x;
    if (limit >= 0) return {limit, factor, exponent};
    return {0, std::max(0.0, xy / xx), exponent};
}

double squared_error(std::span<const LearningPoint> points, const PowerLaw& law) {
    double sum = 0;
    for (const LearningPoint& point : points)
        sum += std::pow(law.error(static_cast<double>(point.shapes)) - point.error, 2);
    return sum;
}

}  // namespace

double PowerLaw::error(double shapes) const {
    return limit + factor * std::pow(shapes, -exponent);
}

PowerLaw fit_power_law(std::span<const LearningPoint> points) {
    std::set<std::size_t> numbers;
    for (const LearningPoint& point : points) numbers.insert(point.shapes);
    if (numbers.size() < 3) throw UsageError("a learning curve needs errors after three different numbers of shapes");
    const auto misfit = [&](double exponent) { return squared_error(points, law_of_exponent(points, exponent)); };
    return law_of_exponent(points, golden_section_minimum(misfit, 0.1, 2, 40).first);
}

}  // namespace exemplar
