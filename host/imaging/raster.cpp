#include "host/imaging/raster.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/imaging/scan_conversion.h"

namespace exemplar {
namespace {

constexpr int k_samples = 2;  // per pixel and axis

/// Linear color of every face, and the light on a visible point.
class Shader {
  public:
    Shader(const TriangleMesh& mesh, std::span<const Color> colors, const Camera& camera, const RenderOptions& options)
        : mesh_(mesh), camera_(camera), options_(options) {
        for (std::size_t i = 0; i < to_linear_.size(); ++i) to_linear_[i] = srgb_to_linear(static_cast<float>(i) / 255);
        for (const Color& color : colors) colors_.push_back(linear(color));
        background_ = linear(options.background);
        normals_ = options.smooth ? vertex_normals(mesh) : face_normals(mesh);
    }

    Vec3 operator()(const VisibleSample& sample) const {
        if (sample.face == k_no_face) return background_;
        const Face& face = mesh_.faces[sample.face];
        Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
        for (std::size_t i = 0; i < 3; ++i) {
            const float w = sample.weight[static_cast<Eigen::Index>(i)];
            point += w * mesh_.vertices[face[i]];
            normal += w * normals_[options_.smooth ? face[i] : sample.face];
        }
        normal.normalize();
        float facing = normal.dot(camera_.to_eye(point));
        if (facing < 0) {
            normal = -normal;
            facing = -facing;
        }
        const float sky = (1 + normal.y()) / 2;
        const float light =
            options_.ambient * (options_.ground + (1 - options_.ground) * sky) + options_.headlight * facing;
        return colors_[sample.face] * light;
    }

  private:
    Vec3 linear(const Color& color) const { return {to_linear_[color[0]], to_linear_[color[1]], to_linear_[color[2]]}; }

    const TriangleMesh& mesh_;
    const Camera& camera_;
    const RenderOptions& options_;
    std::array<float, 256> to_linear_{};
    std::vector<Vec3> colors_, normals_;
    Vec3 background_;
};

}  // namespace

float srgb_to_linear(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float linear_to_srgb(float linear) {
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

Image render_mesh(const TriangleMesh& mesh, std::span<const Color> face_colors, const Camera& camera, int width,
                  int height, const RenderOptions& options) {
    if (width <= 0 || height <= 0) throw UsageError(fmt::format("render_mesh: empty image ({} x {})", width, height));
    if (face_colors.size() != mesh.face_count())
        throw UsageError(fmt::format("render_mesh: {} colors for {} faces; give one color per face", face_colors.size(),
                                     mesh.face_count()));
    const int columns = width * k_samples, rows = height * k_samples;
    const std::vector<VisibleSample> samples = visible_samples(mesh, camera, columns, rows);
    const Shader shade(mesh, face_colors, camera, options);
    Image image(width, height, 3);
    parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
        for (int x = 0; x < width; ++x) {
            Vec3 sum = Vec3::Zero();
            for (std::size_t s = 0; s < k_samples * k_samples; ++s) {
                const std::size_t sy = row * k_samples + s / k_samples;
                const std::size_t sx = static_cast<std::size_t>(x) * k_samples + s % k_samples;
                sum += shade(samples[sy * static_cast<std::size_t>(columns) + sx]).cwiseMin(1.0f);
            }
            const auto pixel = image.pixel(x, static_cast<int>(row));
            for (std::size_t c = 0; c < 3; ++c) {
                const float value = linear_to_srgb(sum[static_cast<Eigen::Index>(c)] / (k_samples * k_samples));
                pixel[c] = static_cast<std::uint8_t>(std::lround(value * 255));
            }
        }
    });
    return image;
}

}  // namespace exemplar
