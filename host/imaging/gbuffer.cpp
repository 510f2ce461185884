#include "host/imaging/gbuffer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double cross(const Vector2d& a, const Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// Returns the barycentric coordinates moved into the triangle.
Vector3d inside(const Vector3d& barycentric) {
    const Vector3d positive = barycentric.cwiseMax(0.0);
    return positive / positive.sum();
}

/// Rays through the centers of an image's pixels.
class PixelRays {
  public:
    PixelRays(const Camera& camera, int width, int height)
        : clip_(camera.view_projection().cast<double>()),
          axis_(-camera.view.row(2).cast<double>()),
          width_(width),
          height_(height) {}

    /// Returns the barycentric coordinates at which the ray of pixel (x, y) meets the plane of the corners. On the
    /// ray two homogeneous functions are zero, (clip.x - ndc.x clip.w) and (clip.y - ndc.y clip.w). They are linear
    /// in the barycentric coordinates, which follow from their values `at` the first corner and along two edges.
    Vector3d meet(int x, int y, const std::array<Vector3d, 3>& corner) const {
        const Eigen::Matrix<double, 2, 4> rows = zero_on_ray(x, y);
        const Vector2d at = rows * corner[0].homogeneous();
        const Vector2d first = rows.leftCols<3>() * (corner[1] - corner[0]);
        const Vector2d second = rows.leftCols<3>() * (corner[2] - corner[0]);
        const double area = cross(first, second);
        if (area == 0.0) return Vector3d::Constant(1.0 / 3.0);  // seen edge-on
        const double b1 = cross(second, at) / area, b2 = cross(at, first) / area;
        return inside({1 - b1 - b2, b1, b2});
    }

    /// Returns the depth along the camera's axis.
    double depth(const Vector3d& point) const { return axis_.dot(point.homogeneous()); }

  private:
    Eigen::Matrix<double, 2, 4> zero_on_ray(int x, int y) const {
        Eigen::Matrix<double, 2, 4> rows;
        rows.row(0) = clip_.row(0) - ((2 * x + 1.0) / width_ - 1) * clip_.row(3);
        rows.row(1) = clip_.row(1) - ((2 * y + 1.0) / height_ - 1) * clip_.row(3);
        return rows;
    }

    Eigen::Matrix4d clip_;
    Eigen::RowVector4d axis_;
    double width_, height_;
};

}  // namespace

void check_gbuffer_size(int width, int height) {
    if (width <= 0 || height <= 0) throw UsageError(fmt::format("G-buffer: empty image ({} x {})", width, height));
}

GBuffer render_gbuffer(const TriangleMesh& mesh, const Camera& camera, int width, int height) {
    check_gbuffer_size(width, height);
    const std::vector<VisibleSample> samples = visible_samples(mesh, camera, width, height);
    const PixelRays rays(camera, width, height);
    GBuffer out{.width = width, .height = height, .face = {}, .barycentric = {}, .depth = {}};
    out.face.assign(out.size(), k_no_face);
    out.barycentric.assign(out.size(), {});
    out.depth.assign(out.size(), std::numeric_limits<float>::infinity());
    parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
        const auto y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const std::size_t pixel = out.index(x, y);
            const std::uint32_t face = out.face[pixel] = samples[pixel].face;
            if (face == k_no_face) continue;
            std::array<Vector3d, 3> corner;
            for (std::size_t i = 0; i < 3; ++i) corner[i] = mesh.vertices[mesh.faces[face][i]].cast<double>();
            const Vector3d b = rays.meet(x, y, corner);
            out.barycentric[pixel] = {static_cast<float>(b[1]), static_cast<float>(b[2])};
            out.depth[pixel] = static_cast<float>(rays.depth(b[0] * corner[0] + b[1] * corner[1] + b[2] * corner[2]));
        }
    });
    return out;
}

}  // namespace exemplar
