#include "host/mesh/curvature/robust_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "host/core/parallel.h"
#include "host/mesh/curvature/tensor_equations.h"

namespace exemplar {

namespace {

constexpr std::size_t k_fit_grain = 64;            // vertices that one thread takes at a time
constexpr std::size_t k_max_expanded_degree = 24;  // the second ring is reached only through vertices of at most this
                                                   // many neighbors
constexpr int k_max_iterations = 20;
constexpr int k_scale_updates = 4;
constexpr std::uint32_t k_none_placed = std::numeric_limits<std::uint32_t>::max();
// Sigma of the estimators in standard deviations of the residuals. With this one Cauchy has 95% of the efficiency of
// least squares under Gaussian noise. A narrower Geman-McClure has several minima even on clean surfaces, and
// neighboring vertices end up in different ones.
constexpr double k_cauchy_width = 1.69, k_geman_mcclure_width = 3;
constexpr double k_converged = 1e-4;  // relative change of the tensor

/// The change along one edge, in the frame of the vertex that is fitted.
template <std::size_t N>
struct Sample {
    double u, v;
    typename TensorEquations<N>::Change change;
    double weight;  ///< by the distance from the vertex
    double squared_residual = 0;
};

/// The median norm of a residual in standard deviations of its N - 1 components, if they are Gaussian: the square
/// root of the median of the chi-squared distribution with N - 1 degrees of freedom.
template <std::size_t N>
constexpr double k_median_norm = N == 3 ? 1.17741 : 1.53817;

/// Returns the squared standard deviation, estimated from the weighted median of the residuals.
template <std::size_t N>
double squared_scale(std::vector<Sample<N>>& samples) {
    std::sort(samples.begin(), samples.end(),
              [](const Sample<N>& a, const Sample<N>& b) { return a.squared_residual < b.squared_residual; });
    double total = 0, below = 0;
    for (const Sample<N>& sample : samples) total += sample.weight;
    for (const Sample<N>& sample : samples) {
        below += sample.weight;
        if (2 * below >= total) return sample.squared_residual / (k_median_norm<N> * k_median_norm<N>);
    }
    return 0;
}

/// Returns the derivative of the cost divided by the residual (Eq. 2.7: Cauchy, Eq. 2.8: Geman and McClure).
double robust_weight(RobustEstimator estimator, double squared_residual, double squared_scale) {
    if (estimator == RobustEstimator::cauchy)
        return 1 / (1 + squared_residual / (2 * k_cauchy_width * k_cauchy_width * squared_scale));
    const double root = 1 / (1 + squared_residual / (k_geman_mcclure_width * k_geman_mcclure_width * squared_scale));
    return root * root;
}

/// Fits by iteratively reweighted least squares; returns nothing if the samples do not determine the tensor.
template <std::size_t N>
std::optional<std::array<double, N>> fit_samples(std::vector<Sample<N>>& samples, RobustEstimator estimator) {
    TensorEquations<N> plain;
    for (const Sample<N>& s : samples) plain.add(s.u, s.v, s.change, s.weight);
    if (!plain.solvable()) return std::nullopt;
    std::array<double, N> x = plain.solve();
    double scale = 0;
    for (int iteration = 0; iteration < k_max_iterations; ++iteration) {
        for (Sample<N>& s : samples) s.squared_residual = TensorEquations<N>::squared_residual(x, s.u, s.v, s.change);
        // Outliers in the first fits distort the first scales, so these are updated. Once the scale is fixed, each
        // step lowers the cost.
        if (iteration < k_scale_updates) scale = squared_scale(samples);
        if (!(scale > 0)) break;  // half of the samples fit exactly
        TensorEquations<N> weighted;
        for (const Sample<N>& s : samples)
            weighted.add(s.u, s.v, s.change, s.weight * robust_weight(estimator, s.squared_residual, scale));
        if (!weighted.solvable()) break;
        const std::array<double, N> next = weighted.solve();
        double change = 0, size = 0;
        for (std::size_t i = 0; i < N; ++i) {
            change = std::max(change, std::abs(next[i] - x[i]));
            size = std::max(size, std::abs(next[i]));
        }
        x = next;
        if (iteration + 1 >= k_scale_updates && change <= k_converged * size) break;
    }
    return x;
}

/// Makes one sample per edge. Edges of the second ring weigh less, else a crease as narrow as one ring would be an
/// outlier at the vertices on it. The width of the weights is the mean distance of the neighbors.
template <std::size_t N>
void add_samples(const std::vector<std::array<double, 2>>& position,
                 const std::vector<typename TensorEquations<N>::Change>& value,
                 std::span<const std::array<std::uint32_t, 2>> edges, std::vector<Sample<N>>& samples) {
    samples.clear();
    double width = 0;
    std::size_t neighbors = 0;
    for (const auto& [a, b] : edges)
        if (a == 0) {
            width += std::hypot(position[b][0], position[b][1]);
            ++neighbors;
        }
    if (!(width > 0)) return;
    width /= static_cast<double>(neighbors);
    for (const auto& [a, b] : edges) {
        const double u = position[b][0] - position[a][0], v = position[b][1] - position[a][1];
        const double x = position[a][0] + u / 2, y = position[a][1] + v / 2;
        Sample<N> sample{u, v, {}, std::exp(-(x * x + y * y) / (2 * width * width)), 0};
        for (std::size_t i = 0; i + 1 < N; ++i) sample.change[i] = value[b][i] - value[a][i];
        samples.push_back(sample);
    }
}

/// Collects the two rings around `center`. Does not reach the second ring through a vertex of many neighbors, such
/// as the center of a fan: around a fan each vertex would reach all others.
void add_rings(std::uint32_t center, const VertexNeighbors& neighbors, std::vector<std::uint32_t>& place,
               std::vector<std::uint32_t>& row) {
    row.assign(1, center);
    place[center] = 0;
    const auto add = [&](std::uint32_t v) {
        if (place[v] != k_none_placed) return;
        place[v] = static_cast<std::uint32_t>(row.size());
        row.push_back(v);
    };
    for (const std::uint32_t v : neighbors.of(center)) add(v);
    for (const std::uint32_t v : neighbors.of(center))
        if (neighbors.of(v).size() <= k_max_expanded_degree)
            for (const std::uint32_t w : neighbors.of(v)) add(w);
}

}  // namespace

RobustFits::RobustFits(const VertexNeighbors& neighbors) {
    const std::size_t count = neighbors.vertex_count();
    std::vector<std::uint32_t> place(count, k_none_placed), row;
    begin_.push_back(0);
    edge_begin_.push_back(0);
    for (std::uint32_t v = 0; v < count; ++v) {
        add_rings(v, neighbors, place, row);
        vertex_.insert(vertex_.end(), row.begin(), row.end());
        for (std::uint32_t i = 0; i < row.size(); ++i)
            for (const std::uint32_t other : neighbors.of(row[i]))
                if (place[other] != k_none_placed && place[other] > i) edge_.push_back({i, place[other]});
        for (const std::uint32_t w : row) place[w] = k_none_placed;
        begin_.push_back(vertex_.size());
        edge_begin_.push_back(edge_.size());
    }
}

/// `value_at(v, other)` is the differentiated quantity at `other`, in the frame of v.
template <std::size_t N, typename ValueAt, typename Result>
void RobustFits::fit_all(std::span<const Vec3> vertices, const std::vector<TangentFrame>& frames,
                         RobustEstimator estimator, ValueAt&& value_at, std::vector<Result>& results) const {
    using Value = typename TensorEquations<N>::Change;
    parallel_ranges(vertices.size(), k_fit_grain, [&](std::size_t begin, std::size_t end) {
        std::vector<std::array<double, 2>> position;
        std::vector<Value> value;
        std::vector<Sample<N>> samples;
        for (std::size_t v = begin; v < end; ++v) {
            const TangentFrame& frame = frames[v];
            position.clear();
            value.clear();
            for (std::size_t i = begin_[v]; i < begin_[v + 1]; ++i) {
                const Vec3 step = vertices[vertex_[i]] - vertices[v];
                position.push_back({frame.tangent.dot(step), frame.bitangent.dot(step)});
                value.push_back(value_at(v, vertex_[i]));
            }
            add_samples<N>(position, value,
                           std::span(edge_).subspan(edge_begin_[v], edge_begin_[v + 1] - edge_begin_[v]), samples);
            const std::optional<std::array<double, N>> tensor = fit_samples<N>(samples, estimator);
            if (!tensor) continue;
            for (std::size_t k = 0; k < N; ++k) results[v][k] = static_cast<float>((*tensor)[k]);
        }
    });
}

void RobustFits::fit(std::span<const Vec3> vertices, const std::vector<TangentFrame>& frames, RobustEstimator estimator,
                     std::vector<Form>& forms) const {
    fit_all<3>(
        vertices, frames, estimator,
        [&](std::size_t v, std::uint32_t other) -> std::array<double, 2> {
            return {frames[v].tangent.dot(frames[other].normal), frames[v].bitangent.dot(frames[other].normal)};
        },
        forms);
}

void RobustFits::fit(std::span<const Vec3> vertices, const std::vector<TangentFrame>& frames, RobustEstimator estimator,
                     const std::vector<Form>& forms, std::vector<FormDerivative>& derivatives) const {
    fit_all<4>(
        vertices, frames, estimator,
        [&](std::size_t v, std::uint32_t other) -> std::array<double, 3> {
            const TangentRotation turn = rotation_to(frames[other], frames[v].tangent, frames[v].normal);
            const Form form = in_rotated_frame(forms[other], turn);
            return {form[0], form[1], form[2]};
        },
        derivatives);
}

}  // namespace exemplar
