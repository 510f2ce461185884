#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/shape/percentile.h"
#include "host/shape/shape_families.h"

namespace exemplar {
namespace {

constexpr std::array<double, 9> k_distance_shares{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
using Statistics = std::array<float, 2 + k_distance_shares.size()>;

/// Mean, mean square and percentiles of the distances from one face to the samples of its component.
Statistics distance_statistics(std::span<const float> distance, std::span<const float> weight,
                               WeightedHistogram& histogram) {
    double total = 0.0, sum = 0.0, squares = 0.0;
    float maximum = 0.0F;
    for (std::size_t s = 0; s < distance.size(); ++s) {
        if (!std::isfinite(distance[s])) continue;
        const double d = static_cast<double>(distance[s]), w = static_cast<double>(weight[s]);
        total += w;
        sum += w * d;
        squares += w * d * d;
        maximum = std::max(maximum, distance[s]);
    }
    histogram.reset(maximum, 256);
    for (std::size_t s = 0; s < distance.size(); ++s) {
        if (std::isfinite(distance[s])) histogram.add(distance[s], static_cast<double>(weight[s]));
    }
    Statistics result{};
    if (total > 0.0) {
        result[0] = static_cast<float>(sum / total);
        result[1] = static_cast<float>(squares / total);
    }
    histogram.percentiles(k_distance_shares, std::span(result).subspan(2));
    return result;
}

}  // namespace

FeatureMatrix geodesic_features(const PreparedMesh& prepared) {
    FeatureMatrix matrix;
    matrix.rows = prepared.face_count();
    matrix.add("geodesic.mean");
    matrix.add("geodesic.mean_square");
    for (int p = 10; p < 100; p += 10) matrix.add("geodesic.p" + std::to_string(p));
    const std::size_t samples = prepared.sample_count();
    parallel_ranges(matrix.rows, 64, [&](std::size_t begin, std::size_t end) {
        std::vector<float> distance;
        gather_distances(prepared, begin, end, distance);
        WeightedHistogram histogram(0.0F, 1);
        for (std::size_t f = begin; f < end; ++f) {
            const std::span<const float> of_face(distance.data() + (f - begin) * samples, samples);
            const Statistics statistics = distance_statistics(of_face, prepared.samples.area_share, histogram);
            for (std::size_t k = 0; k < statistics.size(); ++k) matrix.column(k)[f] = statistics[k];
        }
    });
    for (std::size_t k = 0; k < matrix.cols(); ++k) {
        const std::span<float> column = matrix.column(k);
        const float least = *std::ranges::min_element(column);
        for (float& value : column) value -= least;
    }
    return matrix;
}

}  // namespace exemplar
