#include "host/curvature/learning/learners.h"

#include <algorithm>
#include <array>

#include "host/core/parallel.h"
#include "host/core/progress.h"

namespace exemplar {

namespace {

/// Computes principal components, scaled to unit variance like independent ones.
Ica principal_components(const Eigen::MatrixXf& values, double share) {
    const Pca pca = fit_pca(values, share);
    const Eigen::VectorXf deviation = pca.variance.cast<float>().cwiseSqrt();
    Ica result;
    result.mean = pca.mean;
    result.mixing = pca.basis * deviation.asDiagonal();
    result.unmixing = deviation.cwiseInverse().asDiagonal() * pca.basis.transpose();
    result.sources = pca.project(values) * deviation.cwiseInverse().asDiagonal();
    return result;
}

}  // namespace

Eigen::MatrixXf LearningTask::centered(std::size_t attribute, const std::vector<std::uint32_t>& vertices) const {
    const auto row = static_cast<Eigen::Index>(attribute);
    Eigen::MatrixXf values(poses(), static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i)
        values.col(static_cast<Eigen::Index>(i)) =
            samples.attributes[attribute].col(vertices[i]).array() - means(row, vertices[i]);
    return values;
}

Ica LearningTask::reduce(const Eigen::Ref<const Eigen::MatrixXf>& values, std::size_t attribute,
                         const std::vector<std::uint32_t>& vertices) const {
    Eigen::VectorXf scale(static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i)
        scale[static_cast<Eigen::Index>(i)] = scales(static_cast<Eigen::Index>(attribute), vertices[i]);
    const Eigen::MatrixXf scaled = values * scale.cwiseInverse().asDiagonal();
    Ica result = options.independent ? fit_spatial_ica(scaled, {.share = options.variance, .seed = options.seed})
                                     : principal_components(scaled, options.variance);
    result.mean = scale.asDiagonal() * result.mean;
    result.mixing = scale.asDiagonal() * result.mixing;
    result.unmixing = result.unmixing * scale.cwiseInverse().asDiagonal();
    return result;
}

std::vector<std::uint32_t> LearningTask::varying_vertices() const {
    std::vector<std::uint32_t> vertices;
    for (const InfluenceGroup& group : groups)
        if (!group.controls.empty()) vertices.insert(vertices.end(), group.vertices.begin(), group.vertices.end());
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

std::vector<Ica> LearningTask::reduce_all(const std::vector<std::uint32_t>& vertices) const {
    std::vector<Ica> bases(samples.attributes.size());
    Progress progress("reducing", bases.size());
    parallel_for(bases.size(), [&](std::size_t a) {
        bases[a] = reduce(centered(a, vertices), a, vertices);
        progress.advance();
    });
    return bases;
}

std::vector<Monomial> polynomial_monomials(std::span<const std::uint32_t> inputs, std::size_t input_count, int degree) {
    const auto one = static_cast<std::uint32_t>(input_count);
    std::vector<Monomial> monomials{{one, one, one}};
    for (int power = 1; power <= degree; ++power)
        for (const std::uint32_t x : inputs) monomials.push_back({x, power > 1 ? x : one, power > 2 ? x : one});
    return monomials;
}

Eigen::MatrixXd monomial_values(std::span<const Monomial> monomials, const Eigen::Ref<const Eigen::MatrixXf>& states) {
    Eigen::MatrixXd values = Eigen::MatrixXd::Ones(states.rows(), static_cast<Eigen::Index>(monomials.size()));
    for (std::size_t m = 0; m < monomials.size(); ++m)
        for (const std::uint32_t input : monomials[m])
            if (input < states.cols())
                values.col(static_cast<Eigen::Index>(m)).array() *= states.col(input).cast<double>().array();
    return values;
}

std::vector<std::vector<std::uint32_t>> vertices_of_controls(const LearningTask& task) {
    std::vector<std::vector<std::uint32_t>> vertices(task.reader.controls.size());
    for (const InfluenceGroup& group : task.groups)
        for (const std::uint32_t control : group.controls)
            vertices[control].insert(vertices[control].end(), group.vertices.begin(), group.vertices.end());
    for (auto& list : vertices) std::sort(list.begin(), list.end());
    return vertices;
}

std::span<const double> ridge_candidates() {
    static constexpr std::array<double, 7> k_candidates{1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};
    return k_candidates;
}

std::size_t validation_blocks(Eigen::Index poses) {
    constexpr std::size_t k_blocks = 6;
    return std::clamp<std::size_t>(static_cast<std::size_t>(poses) / 3, 2, k_blocks);
}

}  // namespace exemplar
