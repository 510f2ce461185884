#include "host/hatching/style/familiarity.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/core/statistics.h"
#include "host/hatching/features/pixel_features.h"

namespace exemplar {
namespace {

constexpr std::size_t k_samples = 800;
constexpr std::array<const char*, 12> k_names{
    "image.I@5",      "image.V.N@5",  "image.L.N@5", "image.a@5",  "curvature.mean@0.05",    "diameter.mean@60",
    "medial.mean@60", "geodesic.p50", "pca.s1@0.2",  "pca.s3@0.2", "shape_context.5x6.d2a2", "shape_context.5x6.d3a4"};

std::vector<std::uint32_t> numbers_of_names() {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(k_names.size());
    const std::vector<std::string>& all = pixel_feature_names();
    for (const char* name : k_names)
        numbers.push_back(static_cast<std::uint32_t>(std::ranges::find(all, std::string(name)) - all.begin()));
    return numbers;
}

// Rows whose distances are computed together, in the processor's vectors.
constexpr int k_rows_together = 16;
using BlockValues = Eigen::Array<float, k_rows_together, 1>;

/// Returns the squared distances from z (feature by feature) to the nearest of `samples`.
BlockValues nearest_distances(std::span<const float> samples, const std::array<BlockValues, k_names.size()>& z) {
    BlockValues least = BlockValues::Constant(std::numeric_limits<float>::max());
    for (std::size_t s = 0; s < samples.size(); s += z.size()) {
        BlockValues sum = BlockValues::Zero();
        for (std::size_t k = 0; k < z.size(); ++k) sum += (samples[s + k] - z[k]).square();
        least = least.min(sum);
    }
    return least;
}

/// The values of rows, standardized.
class Standardized {
  public:
    Standardized(const Familiarity& familiarity, std::span<const std::uint32_t> which, const FeatureMatrix& features)
        : familiarity_(familiarity) {
        for (const std::uint32_t feature : familiar_features()) {
            const auto column = std::ranges::find(which, feature);
            if (column == which.end()) throw UsageError("familiarity depends on a feature that was not measured");
            columns_.push_back(features.column(static_cast<std::size_t>(column - which.begin())));
        }
    }
    float operator()(std::size_t row, std::size_t k) const {
        return (columns_[k][row] - familiarity_.offset[k]) * familiarity_.scale[k];
    }
    /// Returns the squared distances of up to k_rows_together rows to the nearest of `samples`.
    BlockValues distances(std::span<const float> samples, std::span<const std::uint32_t> rows) const {
        std::array<BlockValues, k_names.size()> z;
        for (std::size_t k = 0; k < z.size(); ++k) {
            z[k].setZero();
            for (std::size_t i = 0; i < rows.size(); ++i) z[k][static_cast<Eigen::Index>(i)] = (*this)(rows[i], k);
        }
        return nearest_distances(samples, z);
    }

  private:
    const Familiarity& familiarity_;
    std::vector<std::span<const float>> columns_;
};

/// Sets offset and scale to the median and the spread of the values.
void standardize(const FeatureMatrix& features, Familiarity& familiarity) {
    for (const std::uint32_t feature : familiar_features()) {
        const std::span<const float> column = features.column(feature);
        std::vector<float> values(column.begin(), column.end());
        const float low = quantile(values, 0.1), high = quantile(values, 0.9);
        familiarity.offset.push_back(quantile(values, 0.5));
        familiarity.scale.push_back(high > low ? 1 / (high - low) : 0.0f);
    }
}

}  // namespace

const std::vector<std::uint32_t>& familiar_features() {
    static const std::vector<std::uint32_t> k_features = numbers_of_names();
    return k_features;
}

std::vector<float> Familiarity::of(std::span<const std::uint32_t> which, const FeatureMatrix& features) const {
    std::vector<float> out(features.rows, 1.0f);
    if (samples.empty()) return out;
    const Standardized z(*this, which, features);
    const float range = 4 * reach * reach;
    std::vector<std::uint32_t> rows(features.rows);
    std::iota(rows.begin(), rows.end(), 0U);
    parallel_ranges(features.rows, 16 * k_rows_together, [&](std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end; first += k_rows_together) {
            const std::size_t count = std::min<std::size_t>(k_rows_together, end - first);
            const BlockValues distances = z.distances(samples, std::span(rows).subspan(first, count));
            for (std::size_t i = 0; i < count; ++i)
                out[first + i] = std::exp(-distances[static_cast<Eigen::Index>(i)] / range);
        }
    });
    return out;
}

Familiarity learn_familiarity(const FeatureMatrix& features, std::span<const std::uint8_t> held_out,
                              std::uint64_t seed) {
    Familiarity out;
    standardize(features, out);
    std::vector<std::uint32_t> which(features.cols()), order(features.rows);
    std::iota(which.begin(), which.end(), 0U);
    std::iota(order.begin(), order.end(), 0U);
    Random(seed).shuffle(order);
    const Standardized z(out, which, features);
    const auto add = [&](std::uint32_t row, std::vector<float>& samples) {
        if (samples.size() >= k_samples * k_names.size()) return;
        for (std::size_t k = 0; k < k_names.size(); ++k) samples.push_back(z(row, k));
    };
    std::vector<float> outside;
    for (const std::uint32_t row : order)
        if (!held_out[row]) add(row, outside);
    std::vector<float> distances;
    for (const std::uint32_t row : order)
        if (held_out[row] && distances.size() < k_samples)
            distances.push_back(z.distances(outside, std::span(&row, 1))[0]);
    out.reach = std::max(1e-3f, std::sqrt(upper_median(distances)));
    for (const std::uint32_t row : order) add(row, out.samples);
    return out;
}

}  // namespace exemplar
