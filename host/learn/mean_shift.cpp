#include "host/learn/mean_shift.h"

#include <algorithm>
#include <numeric>

#include "host/core/parallel.h"

namespace exemplar {

namespace {

/// Columns are points, so that a point is contiguous.
using Columns = Eigen::MatrixXf;

Columns evenly_taken(const Eigen::Ref<const Eigen::MatrixXf>& points, std::size_t most) {
    const auto count = static_cast<std::size_t>(points.rows()), taken = std::min(count, most);
    Columns columns(points.cols(), static_cast<Eigen::Index>(taken));
    for (std::size_t i = 0; i < taken; ++i)
        columns.col(static_cast<Eigen::Index>(i)) = points.row(static_cast<Eigen::Index>(i * count / taken));
    return columns;
}

Eigen::VectorXf seek_mode(const Columns& sample, Eigen::VectorXf at, float bandwidth) {
    constexpr int k_max_steps = 100;
    const float scale = -0.5f / (bandwidth * bandwidth);
    for (int step = 0; step < k_max_steps; ++step) {
        const Eigen::RowVectorXf weight = ((sample.colwise() - at).colwise().squaredNorm() * scale).array().exp();
        const Eigen::VectorXf next = sample * weight.transpose() / weight.sum();
        const float moved = (next - at).norm();
        at = next;
        if (moved < 1e-3f * bandwidth) break;
    }
    return at;
}

/// Returns one column per mode, without those closer than the bandwidth to an earlier one.
Columns distinct_modes(const Columns& found, float bandwidth) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < found.cols(); ++i) {
        const bool is_new = std::none_of(
            kept.begin(), kept.end(), [&](Eigen::Index k) { return (found.col(i) - found.col(k)).norm() < bandwidth; });
        if (is_new) kept.push_back(i);
    }
    Columns modes(found.rows(), static_cast<Eigen::Index>(kept.size()));
    for (std::size_t i = 0; i < kept.size(); ++i) modes.col(static_cast<Eigen::Index>(i)) = found.col(kept[i]);
    return modes;
}

std::vector<std::uint32_t> nearest_modes(const Eigen::Ref<const Eigen::MatrixXf>& points, const Columns& modes) {
    std::vector<std::uint32_t> nearest(static_cast<std::size_t>(points.rows()));
    parallel_for(
        nearest.size(),
        [&](std::size_t i) {
            Eigen::Index best = 0;
            const Eigen::VectorXf point = points.row(static_cast<Eigen::Index>(i));
            (modes.colwise() - point).colwise().squaredNorm().minCoeff(&best);
            nearest[i] = static_cast<std::uint32_t>(best);
        },
        256);
    return nearest;
}

}  // namespace

MeanShiftClusters mean_shift(const Eigen::Ref<const Eigen::MatrixXf>& points, float bandwidth, std::size_t smallest,
                             std::size_t seeds) {
    if (points.rows() == 0) return {Eigen::MatrixXf(0, points.cols()), {}};
    const Columns sample = evenly_taken(points, seeds);
    Columns found(sample.rows(), sample.cols());
    parallel_for(static_cast<std::size_t>(sample.cols()), [&](std::size_t i) {
        const auto column = static_cast<Eigen::Index>(i);
        found.col(column) = seek_mode(sample, sample.col(column), bandwidth);
    });
    Columns modes = distinct_modes(found, bandwidth);

    std::vector<std::uint32_t> cluster = nearest_modes(points, modes);
    std::vector<std::size_t> size(static_cast<std::size_t>(modes.cols()), 0);
    for (const std::uint32_t c : cluster) ++size[c];
    std::vector<Eigen::Index> order(size.size());
    std::iota(order.begin(), order.end(), 0);
    const auto size_of = [&](Eigen::Index i) { return size[static_cast<std::size_t>(i)]; };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return size_of(a) > size_of(b); });
    while (order.size() > 1 && size_of(order.back()) < std::max<std::size_t>(smallest, 1)) order.pop_back();

    Columns kept(modes.rows(), static_cast<Eigen::Index>(order.size()));
    for (std::size_t i = 0; i < order.size(); ++i) kept.col(static_cast<Eigen::Index>(i)) = modes.col(order[i]);
    return {kept.transpose(), nearest_modes(points, kept)};
}

}  // namespace exemplar
