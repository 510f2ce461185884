#include "host/labeling/features/cubic_patch.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

namespace exemplar {

CubicPatch::CubicPatch(const Vec3& origin, const Vec3& normal, float unit)
    : origin_(origin), x_(normal.unitOrthogonal()), y_(normal.cross(x_)), z_(normal), unit_(unit) {}

void CubicPatch::add(const Vec3& position, const Vec3& normal, float weight) {
    constexpr float k_min_cosine = 0.1F;
    const float nz = normal.dot(z_);
    if (nz < k_min_cosine || !(weight > 0.0F)) return;
    const Vec3 offset = (position - origin_) / unit_;
    const double x = static_cast<double>(offset.dot(x_)), y = static_cast<double>(offset.dot(y_));
    const double slope_x = static_cast<double>(-normal.dot(x_) / nz),
                 slope_y = static_cast<double>(-normal.dot(y_) / nz);
    const double w = static_cast<double>(weight);
    add_row({0.5 * x * x, x * y, 0.5 * y * y, x * x * x, x * x * y, x * y * y, y * y * y,
             static_cast<double>(offset.dot(z_))},
            w);
    add_row({x, y, 0.0, 3.0 * x * x, 2.0 * x * y, y * y, 0.0, slope_x}, w);
    add_row({0.0, x, y, 0.0, x * x, 2.0 * x * y, 3.0 * y * y, slope_y}, w);
}

void CubicPatch::add_row(const std::array<double, k_width>& row, double weight) {
    for (std::size_t i = 0; i < k_width; ++i) {
        const double scaled = weight * row[i];
        for (std::size_t j = 0; j < k_width; ++j) sums_[i * k_width + j] += scaled * row[j];
    }
}

PatchCurvature CubicPatch::solve() const {
    using Sums = Eigen::Matrix<double, k_width, k_width, Eigen::RowMajor>;
    const Eigen::Map<const Sums> sums(sums_.data());
    Eigen::Matrix<double, 7, 7> matrix = sums.topLeftCorner<7, 7>();
    const double scale = matrix.trace();
    if (!(scale > 0.0)) return {};
    // Few or collinear points leave some coefficients undetermined; a slight preference for small ones determines
    // them.
    constexpr double k_ridge = 1e-5, k_least = 1e-14;
    matrix.diagonal().array() += k_ridge * matrix.diagonal().array() + k_least * scale;
    const Eigen::Matrix<double, 7, 1> h = matrix.ldlt().solve(sums.topRightCorner<7, 1>());

    // Curvature is positive where the surface bends away from its normal, that is where h falls.
    const double mean = 0.5 * (h[0] + h[2]), difference = 0.5 * (h[0] - h[2]);
    const double spread = std::hypot(difference, h[1]);
    const double angle =
        0.5 * std::atan2(h[1], difference);  // direction of the larger second derivative, that is of k2
    const auto third = [&h](double u, double v) {
        return 6.0 * std::abs(h[3] * u * u * u + h[4] * u * u * v + h[5] * u * v * v + h[6] * v * v * v);
    };
    const double unit = static_cast<double>(unit_);
    return {static_cast<float>((spread - mean) / unit), static_cast<float>((-spread - mean) / unit),
            static_cast<float>(third(-std::sin(angle), std::cos(angle)) / (unit * unit)),
            static_cast<float>(third(std::cos(angle), std::sin(angle)) / (unit * unit))};
}

}  // namespace exemplar
