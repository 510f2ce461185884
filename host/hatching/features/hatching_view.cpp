#include "host/hatching/features/hatching_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/lines/extraction/view_curvature.h"
#include "host/shape/shape_families.h"

namespace exemplar {
namespace {

constexpr std::array<const char*, k_curvature_functions> k_functions{
    "mean", "gaussian", "k_max",  "k_min",    "k_large",  "k_small",  "c111",   "c112",
    "c122", "c222",     "radial", "d_radial", "view_max", "view_min", "torsion"};

struct VertexState {
    float k1, k2;
    std::array<float, 4> derivative;
    ViewVector view;
};

/// Values are in units of the median distance, clamped to `limit` (second-order values to its square).
std::array<float, k_curvature_functions> curvature_functions(const VertexState& at, float limit) {
    const auto first = [&](float value) { return std::clamp(value, -limit, limit); };
    const auto second = [&](float value) { return std::clamp(value, -limit * limit, limit * limit); };
    const float u = at.view.u, v = at.view.v, squared_sine = std::max(u * u + v * v, 1e-6f);
    const ViewCurvature seen = view_curvature(at.k1, at.k2, at.view);
    const bool first_is_large = std::abs(at.k1) >= std::abs(at.k2);
    return {first(0.5f * (at.k1 + at.k2)),
            second(at.k1 * at.k2),
            first(at.k1),
            first(at.k2),
            first(first_is_large ? at.k1 : at.k2),
            first(first_is_large ? at.k2 : at.k1),
            second(at.derivative[0]),
            second(at.derivative[1]),
            second(at.derivative[2]),
            second(at.derivative[3]),
            first((at.k1 * u * u + at.k2 * v * v) / squared_sine),
            second(radial_derivative(at.k1, at.k2, at.derivative, at.view) / std::sqrt(squared_sine)),
            first(std::sqrt(seen.q)),
            first(std::sqrt(seen.least)),
            first((at.k2 - at.k1) * u * v / squared_sine)};
}

}  // namespace

Vec3 light_from(const Camera& camera, const Vec3& direction) {
    return (camera.view.topLeftCorner<3, 3>().transpose() * direction).normalized();
}

Vec3 default_light(const Camera& camera) {
    return light_from(camera, {-0.45f, 0.55f, 0.7f});
}

float size_in_view(const HatchingSurface& surface, const HatchingView& view) {
    const BoundingBox box = bounding_box(surface.mesh);
    const Vec3 middle = (0.5 * (box.low + box.high)).cast<float>();
    const Eigen::Matrix4f& projection = view.camera.projection;
    const float depth = (view.camera.view_projection() * middle.homogeneous()).w();
    // The middle may lie behind an eye that is inside of the object.
    const float least = projection(3, 3) == 1 ? 1 : 0.1f * static_cast<float>(box.diagonal());
    return surface.unit * 0.5f * static_cast<float>(view.height) * std::abs(projection(1, 1)) / std::max(depth, least);
}

Vec2 projected_direction(const HatchingView& view, const Eigen::Matrix4f& view_projection, const Vec3& point,
                         const Vec3& direction) {
    const Eigen::Vector4f at = view_projection * point.homogeneous();
    const Eigen::Vector4f way = view_projection.leftCols<3>() * direction;
    const float scale = 1 / (at.w() * at.w());
    return {scale * (way.x() * at.w() - at.x() * way.w()) * static_cast<float>(view.width),
            scale * (way.y() * at.w() - at.y() * way.w()) * static_cast<float>(view.height)};
}

CoveredPixels covered_pixels(const GBuffer& gbuffer) {
    CoveredPixels out;
    out.row.assign(gbuffer.size(), -1);
    for (std::uint32_t p = 0; p < gbuffer.size(); ++p) {
        if (gbuffer.face[p] == k_no_face) continue;
        out.row[p] = static_cast<std::int32_t>(out.pixel.size());
        out.pixel.push_back(p);
    }
    return out;
}

std::vector<std::string> view_curvature_names() {
    std::vector<std::string> names;
    for (const double scale : k_hatching_scales) {
        for (const char* function : k_functions) {
            names.push_back(at_radius(std::string("curvature.") + function, scale));
            names.push_back(at_radius(std::string("curvature.|") + function + "|", scale));
        }
    }
    return names;
}

FeatureMatrix view_curvature_features(const HatchingSurface& surface, const HatchingView& view) {
    FeatureMatrix out;
    out.rows = surface.mesh.vertex_count();
    for (std::string& name : view_curvature_names()) out.add(std::move(name));
    const float unit = surface.unit;
    parallel_for(
        out.rows,
        [&](std::size_t v) {
            const Vec3 w = view.camera.to_eye(surface.mesh.vertices[v]);
            for (std::size_t s = 0; s < k_hatching_scales.size(); ++s) {
                const VertexCurvature& c = surface.curvature[s];
                std::array<float, 4> derivative = c.derivative[v];
                for (float& value : derivative) value *= unit * unit;
                const VertexState state{c.k1[v] * unit,
                                        c.k2[v] * unit,
                                        derivative,
                                        {c.e1[v].dot(w), c.e2[v].dot(w), surface.normals[v].dot(w)}};
                const auto values = curvature_functions(state, 2 / static_cast<float>(k_hatching_scales[s]));
                for (std::size_t k = 0; k < values.size(); ++k) {
                    const std::size_t column = 2 * (s * values.size() + k);
                    out.column(column)[v] = values[k];
                    out.column(column + 1)[v] = std::abs(values[k]);
                }
            }
        },
        256);
    return out;
}

}  // namespace exemplar
