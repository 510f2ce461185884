#include "host/hatching/registration/light_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/statistics.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/imaging/gbuffer.h"

namespace exemplar {
namespace {

constexpr int k_light_rounds = 20;

/// A pixel of the object: its normal in eye coordinates, turned to the eye, and its brightness.
struct LitPixel {
    Vec3 normal;
    float brightness;
};

std::vector<LitPixel> lit_pixels(const FloatImage& brightness, const TriangleMesh& mesh, const ViewPose& pose,
                                 const PoseFrame& frame, float smoothing) {
    const GBuffer gbuffer = render_gbuffer(mesh, pose_camera(pose, frame), frame.width, frame.height);
    const std::vector<Vec3> normals = vertex_normals(mesh);
    // A blur over the object alone: the paper around it is neither lit nor dark.
    FloatImage inside(frame.width, frame.height, 1), weighted = inside;
    for (std::size_t i = 0; i < inside.data.size(); ++i) {
        inside.data[i] = gbuffer.face[i] == k_no_face ? 0.0f : 1.0f;
        weighted.data[i] = inside.data[i] * brightness.data[i];
    }
    const FloatImage sum = gaussian_blur(weighted, smoothing), weight = gaussian_blur(inside, smoothing);
    std::vector<LitPixel> pixels;
    for (std::size_t i = 0; i < inside.data.size(); ++i) {
        if (gbuffer.face[i] == k_no_face) continue;
        const Face& face = mesh.faces[gbuffer.face[i]];
        const auto [b, c] = gbuffer.barycentric[i];
        Vec3 normal = (1 - b - c) * normals[face[0]] + b * normals[face[1]] + c * normals[face[2]];
        normal = (pose.axes.cast<float>() * normal).normalized();
        if (!normal.allFinite()) continue;
        pixels.push_back({normal.z() < 0 ? Vec3(-normal) : normal, sum.data[i] / std::max(weight.data[i], 1e-6f)});
    }
    return pixels;
}

/// Least squares of brightness = a + b . n over the pixels that `light` falls on; returns the direction of b.
Vec3 better_light(const std::vector<LitPixel>& pixels, const Vec3& light) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Identity() * 1e-6;
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const LitPixel& pixel : pixels) {
        if (pixel.normal.dot(light) <= 0) continue;
        Eigen::Vector4d row;
        row << 1, pixel.normal.cast<double>();
        normal += row * row.transpose();
        right += static_cast<double>(pixel.brightness) * row;
    }
    const Vec3d b = normal.ldlt().solve(right).tail<3>();
    return b.norm() > 0 ? Vec3(b.normalized().cast<float>()) : light;
}

double correlation_of(const std::vector<LitPixel>& pixels, const Vec3& light) {
    double count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (const LitPixel& pixel : pixels) {
        const double lit = std::max(0.0, static_cast<double>(pixel.normal.dot(light)));
        const double bright = static_cast<double>(pixel.brightness);
        count += 1, x += lit, y += bright, xx += lit * lit, xy += lit * bright, yy += bright * bright;
    }
    const double across = (xx - x * x / count) * (yy - y * y / count);
    return count > 1 && across > 0 ? (xy - x * y / count) / std::sqrt(across) : 0;
}

}  // namespace

LightFit fit_light(const FloatImage& brightness, const TriangleMesh& mesh, const ViewPose& pose, const PoseFrame& frame,
                   float smoothing) {
    if (brightness.width != frame.width || brightness.height != frame.height || brightness.channels != 1)
        throw UsageError("fit_light: the picture has not the frame's size");
    const std::vector<LitPixel> pixels = lit_pixels(brightness, mesh, pose, frame, smoothing);
    LightFit fit;
    for (int round = 0; round < k_light_rounds; ++round) fit.direction = better_light(pixels, fit.direction);
    fit.correlation = pixels.empty() ? 0 : correlation_of(pixels, fit.direction);
    return fit;
}

}  // namespace exemplar
