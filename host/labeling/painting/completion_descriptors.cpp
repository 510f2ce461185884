#include "host/labeling/painting/completion_descriptors.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "host/core/parallel.h"
#include "host/learn/decompositions.h"

namespace exemplar {
namespace {

constexpr float k_clip = 3;  ///< standard deviations

/// Standardizes a column over the surface; all zeros if it does not vary.
void standardize(std::span<const float> column, std::span<const float> area, float scale, std::span<float> out) {
    double total = 0, sum = 0, squares = 0;
    for (std::size_t f = 0; f < column.size(); ++f) {
        const double value = static_cast<double>(column[f]), weight = static_cast<double>(area[f]);
        total += weight, sum += weight * value, squares += weight * value * value;
    }
    const double mean = total > 0 ? sum / total : 0;
    const double variance = total > 0 ? squares / total - mean * mean : 0;
    const double inverse = variance > 1e-12 * (1e-12 + mean * mean) ? 1 / std::sqrt(variance) : 0;
    for (std::size_t f = 0; f < column.size(); ++f) {
        const auto z = static_cast<float>((static_cast<double>(column[f]) - mean) * inverse);
        out[f] = scale * std::clamp(z, -k_clip, k_clip);
    }
}

std::string family_of(const std::string& name) {
    return name.substr(0, name.find('.'));
}

/// Returns the columns that are used, each with the weight that makes families count the same.
std::vector<std::pair<std::size_t, float>> weighted_columns(const FeatureMatrix& features) {
    std::map<std::string, std::size_t> size;
    for (const std::string& name : features.names)
        if (!is_appended(name)) ++size[family_of(name)];
    std::vector<std::pair<std::size_t, float>> columns;
    columns.reserve(features.cols());
    for (std::size_t c = 0; c < features.cols(); ++c) {
        const auto family = size.find(family_of(features.names[c]));
        if (family != size.end()) columns.emplace_back(c, 1 / std::sqrt(static_cast<float>(family->second)));
    }
    return columns;
}

}  // namespace

FaceDescriptors face_descriptors(const MeshFeatures& features, std::size_t max_dimensions) {
    const std::size_t faces = features.face_area.size();
    const auto columns = weighted_columns(features.unary);
    Eigen::MatrixXf standardized(static_cast<Eigen::Index>(faces), static_cast<Eigen::Index>(columns.size()));
    parallel_for(columns.size(), [&](std::size_t c) {
        standardize(features.unary.column(columns[c].first), features.face_area, columns[c].second,
                    {standardized.col(static_cast<Eigen::Index>(c)).data(), faces});
    });
    const Eigen::Map<const Eigen::VectorXf> area(features.face_area.data(), static_cast<Eigen::Index>(faces));
    const float total = std::max(area.sum(), 1e-20F);
    const Eigen::MatrixXf weighted = standardized.array().colwise() * area.array();
    const Eigen::MatrixXf covariance = standardized.transpose() * weighted / total;
    const SymmetricEigen eigen = symmetric_eigen(covariance.cast<double>());
    const auto dimensions = static_cast<Eigen::Index>(std::min(max_dimensions, columns.size()));
    const double kept = std::max(eigen.values.tail(dimensions).sum(), 1e-20);
    const Eigen::MatrixXf basis =
        (eigen.vectors.rightCols(dimensions).rowwise().reverse() / std::sqrt(2 * kept)).cast<float>();

    FaceDescriptors descriptors;
    descriptors.dimensions = static_cast<std::size_t>(dimensions);
    descriptors.values.resize(faces * descriptors.dimensions);
    using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(descriptors.values.data(), static_cast<Eigen::Index>(faces), dimensions) =
        standardized * basis;
    return descriptors;
}

}  // namespace exemplar
