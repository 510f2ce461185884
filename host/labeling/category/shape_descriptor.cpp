#include "host/labeling/category/shape_descriptor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

constexpr const char* k_centrality = "geodesic.mean";
/// A deviation below this share of the mean is rounding.
constexpr double k_min_descriptor_variation = 1e-6;

/// Returns the weight of each face; they sum to 1.
std::vector<double> face_weights(const std::vector<float>& area) {
    double sum = 0;
    for (const float a : area) sum += static_cast<double>(a);
    const bool usable = sum > 0 && std::isfinite(sum);
    std::vector<double> weights;
    weights.reserve(area.size());
    for (const float a : area)
        weights.push_back(usable ? static_cast<double>(a) / sum : 1.0 / static_cast<double>(area.size()));
    return weights;
}

/// Statistics of a feature's values over the surface.
struct Spread {
    double mean = 0, deviation = 0;
};

Spread spread_of(std::span<const float> values, std::span<const double> weights) {
    Spread spread;
    for (std::size_t f = 0; f < values.size(); ++f) spread.mean += weights[f] * static_cast<double>(values[f]);
    double variance = 0;
    for (std::size_t f = 0; f < values.size(); ++f) {
        const double difference = static_cast<double>(values[f]) - spread.mean;
        variance += weights[f] * difference * difference;
    }
    const double deviation = std::sqrt(variance);
    spread.deviation = deviation > k_min_descriptor_variation * std::abs(spread.mean) ? deviation : 0;
    return spread;
}

/// Centered values over their deviation; zeros if they do not vary.
std::vector<double> standardized(std::span<const float> values, const Spread& spread) {
    std::vector<double> result(values.size(), 0);
    if (spread.deviation > 0)
        for (std::size_t f = 0; f < values.size(); ++f)
            result[f] = (static_cast<double>(values[f]) - spread.mean) / spread.deviation;
    return result;
}

double correlation(std::span<const float> values, const Spread& spread, std::span<const double> other,
                   std::span<const double> weights) {
    if (spread.deviation == 0) return 0;
    double sum = 0;
    for (std::size_t f = 0; f < values.size(); ++f)
        sum += weights[f] * (static_cast<double>(values[f]) - spread.mean) * other[f];
    return std::clamp(sum / spread.deviation, -1.0, 1.0);
}

}  // namespace

ShapeDescriptor compute_shape_descriptor(const MeshFeatures& features) {
    const FeatureMatrix& unary = features.unary;
    const auto central = std::ranges::find(unary.names, k_centrality);
    if (unary.rows == 0 || features.face_area.size() != unary.rows)
        throw UsageError("a shape is described by the features and areas of its faces, of which there are none");
    if (central == unary.names.end())
        throw UsageError(fmt::format("a shape is described with the feature {}, which is not there", k_centrality));
    const auto own_end = std::ranges::find_if(unary.names, is_appended);

    ShapeDescriptor shape;
    shape.features.assign(unary.names.begin(), own_end);
    const std::size_t count = shape.features.size();
    shape.values.resize(k_shape_statistics * count);
    const std::vector<double> weights = face_weights(features.face_area);
    const auto axis = unary.column(static_cast<std::size_t>(central - unary.names.begin()));
    const std::vector<double> centrality = standardized(axis, spread_of(axis, weights));
    parallel_for(count, [&](std::size_t k) {
        const Spread spread = spread_of(unary.column(k), weights);
        shape.values[k] = static_cast<float>(spread.mean);
        shape.values[count + k] = static_cast<float>(spread.deviation);
        shape.values[2 * count + k] = static_cast<float>(correlation(unary.column(k), spread, centrality, weights));
    });
    return shape;
}

}  // namespace exemplar
