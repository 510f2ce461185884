#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "host/mesh/curvature/curvature.h"
#include "tests/parity/surfaces.h"

/// Curvature of the device, compared in space.
namespace exemplar::test_support {

using Tensor2 = Eigen::Matrix3d;
using Tensor3 = std::array<Eigen::Matrix3d, 3>;

/// As buffers of the device have it; work must be done.
inline VertexCurvature download_curvature(const Buffer& first, const Buffer& second, const Buffer& derivative) {
    VertexCurvature result;
    for (const shared::vec4& v : download(first)) {
        result.e1.push_back(xyz(v));
        result.k1.push_back(v.w);
    }
    for (const shared::vec4& v : download(second)) {
        result.e2.push_back(xyz(v));
        result.k2.push_back(v.w);
    }
    for (const shared::vec4& v : download(derivative)) result.derivative.push_back({v.x, v.y, v.z, v.w});
    return result;
}

/// Of GpuCurvature or what has its outputs.
template <typename DeviceCurvature>
VertexCurvature download_curvature(const DeviceCurvature& curvature) {
    return download_curvature(curvature.first(), curvature.second(), curvature.derivative());
}

/// In space, so that it does not matter how the principal directions are signed, nor where they are at umbilics.
inline Tensor2 form_in_space(const VertexCurvature& c, std::size_t v) {
    const Vec3d e1 = c.e1[v].cast<double>(), e2 = c.e2[v].cast<double>();
    return static_cast<double>(c.k1[v]) * e1 * e1.transpose() + static_cast<double>(c.k2[v]) * e2 * e2.transpose();
}

inline Tensor3 derivative_in_space(const VertexCurvature& c, std::size_t v) {
    const Vec3d e1 = c.e1[v].cast<double>(), e2 = c.e2[v].cast<double>();
    const auto& d = c.derivative[v];
    Tensor3 result;
    for (Eigen::Index i = 0; i < 3; ++i) {
        const auto slice = [&](float d11, float d12, float d22) -> Eigen::Matrix3d {
            return static_cast<double>(d11) * e1 * e1.transpose() + static_cast<double>(d22) * e2 * e2.transpose() +
                   static_cast<double>(d12) * (e1 * e2.transpose() + e2 * e1.transpose());
        };
        result[static_cast<std::size_t>(i)] = e1[i] * slice(d[0], d[1], d[2]) + e2[i] * slice(d[1], d[2], d[3]);
    }
    return result;
}

inline double size_of(const Tensor3& a) {
    return std::sqrt(a[0].squaredNorm() + a[1].squaredNorm() + a[2].squaredNorm());
}

inline double distance(const Tensor3& a, const Tensor3& b) {
    return size_of({a[0] - b[0], a[1] - b[1], a[2] - b[2]});
}

inline bool same_bits(const std::vector<shared::vec4>& a, const std::vector<shared::vec4>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(shared::vec4)) == 0;
}

}  // namespace exemplar::test_support
