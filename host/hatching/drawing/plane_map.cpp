#include "host/hatching/drawing/plane_map.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace exemplar {
namespace {

using Eigen::Vector2d;

std::array<double, 4> bilinear(const Image& image, const Vector2d& place) {
    const double x = std::clamp(place.x() - 0.5, 0.0, static_cast<double>(image.width - 1));
    const double y = std::clamp(place.y() - 0.5, 0.0, static_cast<double>(image.height - 1));
    const int left = static_cast<int>(x), top = static_cast<int>(y);
    const int right = std::min(left + 1, image.width - 1), below = std::min(top + 1, image.height - 1);
    const double u = x - left, v = y - top;
    std::array<double, 4> value{};
    for (std::size_t c = 0; c < static_cast<std::size_t>(image.channels); ++c)
        value[c] = (1 - v) * ((1 - u) * image.pixel(left, top)[c] + u * image.pixel(right, top)[c]) +
                   v * ((1 - u) * image.pixel(left, below)[c] + u * image.pixel(right, below)[c]);
    return value;
}

}  // namespace

PlaneMap::PlaneMap(const std::array<Vector2d, 4>& from, const std::array<Vector2d, 4>& to) {
    Eigen::Matrix<double, 8, 8> equations;
    Eigen::Matrix<double, 8, 1> right;
    for (std::size_t i = 0; i < 4; ++i) {
        const double x = from[i].x(), y = from[i].y();
        for (int axis = 0; axis < 2; ++axis) {
            const auto row = static_cast<Eigen::Index>(2 * i) + axis;
            const double target = to[i][axis];
            equations.row(row).setZero();
            equations.block<1, 3>(row, 3 * axis) << x, y, 1;
            equations.block<1, 2>(row, 6) << -x * target, -y * target;
            right[row] = target;
        }
    }
    const Eigen::Matrix<double, 8, 1> solution = equations.fullPivLu().solve(right);
    matrix_ << solution[0], solution[1], solution[2], solution[3], solution[4], solution[5], solution[6], solution[7],
        1;
}

Vector2d PlaneMap::apply(const Vector2d& place) const {
    const Eigen::Vector3d mapped = matrix_ * place.homogeneous();
    return mapped.head<2>() / mapped.z();
}

std::array<double, 4> mean_at(const Image& image, const Vector2d& place, double side) {
    const int samples = std::clamp(static_cast<int>(std::ceil(side)), 1, 8);
    std::array<double, 4> sum{};
    for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i) {
            const Vector2d offset((i + 0.5) / samples - 0.5, (j + 0.5) / samples - 0.5);
            const auto value = bilinear(image, place + side * offset);
            for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += value[c] / (samples * samples);
        }
    return sum;
}

}  // namespace exemplar
