#include "host/learn/boosting/boosting_weights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/core/parallel.h"

namespace exemplar {
namespace {

constexpr double k_tiny_weight = 1e-300;  // keeps an empty side's 0 / 0 at 0
/// Minimum weight: one that became zero or denormal could not grow again, and denormals are slow.
constexpr float k_min_weight = 1e-30f;

/// Sum of the weights of a chunk's rows, per lane, below and above the split.
struct SideSums {
    std::vector<double> below, above;
};

template <int width>
void add_sides(const LaneFloats<width>* weights, const std::uint8_t* bins, std::size_t count, std::uint32_t threshold,
               double* below, double* above) {
    LaneDoubles<width> side[2] = {};
    for (std::size_t i = 0; i < count; ++i) {
        side[bins[i] > threshold] += __builtin_convertvector(weights[i], LaneDoubles<width>);
    }
    for (int l = 0; l < width; ++l) below[l] = side[0][l], above[l] = side[1][l];
}

SideSums side_sums(const BoostingRows& rows, const RowChunk& chunk, const SplitCandidate& split) {
    SideSums sums{std::vector<double>(rows.layout.padded()), std::vector<double>(rows.layout.padded())};
    with_width(rows.layout, [&]<int width>() {
        for (std::size_t panel = 0; panel < rows.layout.panels; ++panel) {
            add_sides<width>(reinterpret_cast<const LaneFloats<width>*>(rows.panel(panel)) + chunk.begin,
                             rows.column(split.feature) + chunk.begin, chunk.end - chunk.begin, split.threshold,
                             sums.below.data() + panel * width, sums.above.data() + panel * width);
        }
    });
    return sums;
}

/// W and S = sum of z w of one side and lane.
struct Sums {
    double w = 0, s = 0;

    void add(double weight, bool own) { w += weight, s += own ? weight : -weight; }
    double mean() const { return s / (w + k_tiny_weight); }
};

/// Returns exp(-z h) of all lanes on one side, times 2^exponent, rounded to float like the weights. Padding lanes
/// get 1.
LaneFactors make_factors(const LaneLayout& layout, const SplitCandidate& split, float shared_response,
                         const std::vector<float>& elsewhere, int exponent) {
    LaneFactors factors{std::vector<double>(layout.padded(), 1.0), std::vector<double>(layout.padded(), 1.0)};
    for (std::size_t l = 0; l < layout.lanes; ++l) {
        const auto h = static_cast<double>(split.lanes >> l & 1 ? shared_response : elsewhere[l]);
        factors.own[l] = static_cast<double>(static_cast<float>(std::ldexp(std::exp(-h), exponent)));
        factors.other[l] = static_cast<double>(static_cast<float>(std::ldexp(std::exp(h), exponent)));
    }
    return factors;
}

/// Returns the factors of a chunk's rows: z is -1 except in the chunk's own lane.
AlignedFloats chunk_factors(const RowChunk& chunk, const LaneFactors& factors) {
    AlignedFloats out(factors.other.begin(), factors.other.end());
    if (chunk.lane != k_no_lane) {
        const auto own = static_cast<std::size_t>(chunk.lane);
        out[own] = static_cast<float>(factors.own[own]);
    }
    return out;
}

/// Multiplies the weights of rows and returns their new sum.
template <int width>
double scale_rows(LaneFloats<width>* weights, const std::uint8_t* bins, std::size_t count, std::uint32_t threshold,
                  const float* below, const float* above, const float* least) {
    using Floats = LaneFloats<width>;
    const Floats factor[2] = {*reinterpret_cast<const Floats*>(below), *reinterpret_cast<const Floats*>(above)};
    const Floats floor = *reinterpret_cast<const Floats*>(least);
    LaneDoubles<width> sum{};
    for (std::size_t i = 0; i < count; ++i) {
        Floats value = weights[i] * factor[bins[i] > threshold];
        value = value > floor ? value : floor;
        weights[i] = value;
        sum += __builtin_convertvector(value, LaneDoubles<width>);
    }
    double total = 0.0;
    for (int l = 0; l < width; ++l) total += sum[l];
    return total;
}

double scale_chunk(BoostingRows& rows, const RowChunk& chunk, const SplitCandidate& split,
                   const WeightFactors& factors) {
    const LaneLayout& layout = rows.layout;
    const AlignedFloats below = chunk_factors(chunk, factors.below), above = chunk_factors(chunk, factors.above);
    AlignedFloats least(layout.padded(), 0.0f);
    std::fill_n(least.begin(), layout.lanes, k_min_weight);
    double total = 0.0;
    with_width(layout, [&]<int width>() {
        for (std::size_t panel = 0; panel < layout.panels; ++panel) {
            const std::size_t at = panel * width;
            total += scale_rows<width>(reinterpret_cast<LaneFloats<width>*>(rows.panel(panel)) + chunk.begin,
                                       rows.column(split.feature) + chunk.begin, chunk.end - chunk.begin,
                                       split.threshold, &below[at], &above[at], &least[at]);
        }
    });
    return total;
}

}  // namespace

StumpResponse StumpResponse::scaled(float factor) const {
    StumpResponse out{factor * above, factor * below, elsewhere};
    for (float& k : out.elsewhere) k *= factor;
    return out;
}

StumpResponse fit_response(const BoostingRows& rows, const SplitCandidate& split) {
    std::vector<SideSums> of_chunk(rows.chunks.size());
    parallel_for(of_chunk.size(), [&](std::size_t i) { of_chunk[i] = side_sums(rows, rows.chunks[i], split); });
    StumpResponse response{0, 0, std::vector<float>(rows.layout.lanes, 0.0f)};
    Sums below, above;
    for (std::size_t l = 0; l < rows.layout.lanes; ++l) {
        const bool shared = split.lanes >> l & 1;
        Sums all;
        for (std::size_t i = 0; i < of_chunk.size(); ++i) {
            const bool own = rows.chunks[i].lane == static_cast<std::int32_t>(l);
            (shared ? below : all).add(of_chunk[i].below[l], own);
            (shared ? above : all).add(of_chunk[i].above[l], own);
        }
        if (!shared) response.elsewhere[l] = static_cast<float>(all.mean());
    }
    response.above = static_cast<float>(above.mean());
    response.below = static_cast<float>(below.mean());
    return response;
}

WeightUpdate::WeightUpdate(BoostingRows& rows) {
    const double total = std::accumulate(rows.weights.begin(), rows.weights.end(), 0.0);
    for (float& weight : rows.weights) weight = static_cast<float>(static_cast<double>(weight) / total);
}

double WeightUpdate::apply(BoostingRows& rows, const SplitCandidate& split, const StumpResponse& response) {
    const int step = total_ < 0x1p-10 ? -std::ilogb(total_) : 0;
    exponent_ += step;
    factors_.below = make_factors(rows.layout, split, response.below, response.elsewhere, step);
    factors_.above = make_factors(rows.layout, split, response.above, response.elsewhere, step);
    std::vector<double> of_chunk(rows.chunks.size());
    parallel_for(of_chunk.size(),
                 [&](std::size_t i) { of_chunk[i] = scale_chunk(rows, rows.chunks[i], split, factors_); });
    total_ = std::accumulate(of_chunk.begin(), of_chunk.end(), 0.0);
    return std::ldexp(total_, -exponent_);
}

}  // namespace exemplar
