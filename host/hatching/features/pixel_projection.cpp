#include "host/hatching/features/pixel_projection.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

void check_columns(std::size_t columns, const FacePoints& points, std::span<const std::uint32_t> which,
                   std::span<const float> out) {
    for (const std::uint32_t k : which) {
        if (k >= columns) throw UsageError(fmt::format("there is no column {}; there are {}", k, columns));
    }
    if (out.size() != which.size() * points.size())
        throw UsageError(
            fmt::format("{} columns of {} points do not fit into {} values", which.size(), points.size(), out.size()));
}

/// Interpolates unsigned directions at a point, with the signs of the first that is not zero.
Vec3 interpolate_direction(const TriangleMesh& mesh, const FacePoints& points, std::size_t i,
                           std::span<const Vec3> values) {
    const Face& face = mesh.faces[points.face[i]];
    const auto& [b, c] = points.barycentric[i];
    const Vec3 &first = values[face[0]], &second = values[face[1]], &third = values[face[2]];
    const auto turned = [](float weight, const Vec3& to, const Vec3& direction) {
        return Vec3((to.dot(direction) < 0 ? -weight : weight) * direction);
    };
    const Vec3& leading = first.squaredNorm() > 0 ? first : second;
    return (1 - b - c) * first + turned(b, leading, second) + turned(c, leading, third);
}

}  // namespace

void check_projection(const TriangleMesh& mesh, const FacePoints& points) {
    if (points.barycentric.size() != points.face.size())
        throw UsageError(fmt::format("{} points have {} faces", points.barycentric.size(), points.face.size()));
    for (const std::uint32_t face : points.face) {
        if (face >= mesh.face_count())
            throw UsageError(fmt::format("there is no face {}; the mesh has {}", face, mesh.face_count()));
    }
    for (const Face& face : mesh.faces) {
        if (std::ranges::max(face) >= mesh.vertex_count())
            throw UsageError(
                fmt::format("there is no vertex {}; the mesh has {}", std::ranges::max(face), mesh.vertex_count()));
    }
}

void check_scalars(const TriangleMesh& mesh, const FacePoints& points, const FeatureMatrix& values,
                   std::span<const std::uint32_t> which, std::span<const float> out) {
    check_projection(mesh, points);
    if (values.rows != mesh.vertex_count() || values.values.size() != values.rows * values.cols())
        throw UsageError(fmt::format("columns of {} values are not of {} vertices", values.rows, mesh.vertex_count()));
    check_columns(values.cols(), points, which, out);
}

void check_curvature(const HatchingSurface& surface, const FacePoints& points, std::span<const std::uint32_t> which,
                     std::span<const float> out) {
    check_projection(surface.mesh, points);
    const auto fits = [&](const VertexCurvature& c) {
        const std::size_t vertices = surface.mesh.vertex_count();
        return c.k1.size() == vertices && c.k2.size() == vertices && c.e1.size() == vertices &&
               c.e2.size() == vertices && c.derivative.size() == vertices && surface.normals.size() == vertices;
    };
    if (!std::ranges::all_of(surface.curvature, fits)) throw UsageError("the surface's curvature is not measured");
    check_columns(k_view_curvature_columns, points, which, out);
}

void check_directions(const TriangleMesh& mesh, const FacePoints& points, std::span<const std::span<const Vec3>> fields,
                      std::span<const DoubledAngle> out) {
    check_projection(mesh, points);
    for (const std::span<const Vec3> field : fields) {
        if (field.size() != mesh.vertex_count())
            throw UsageError(fmt::format("{} directions are not of {} vertices", field.size(), mesh.vertex_count()));
    }
    if (out.size() != fields.size() * points.size())
        throw UsageError(fmt::format("{} fields of {} points do not fit into {} directions", fields.size(),
                                     points.size(), out.size()));
}

void CpuPixelProjection::scalars(const TriangleMesh& mesh, const FacePoints& points, const FeatureMatrix& values,
                                 std::span<const std::uint32_t> which, std::span<float> out) {
    check_scalars(mesh, points, values, which, out);
    for (std::size_t k = 0; k < which.size(); ++k) {
        const std::span<const float> column = values.column(which[k]);
        const std::span<float> projected = out.subspan(k * points.size(), points.size());
        parallel_for(
            points.size(), [&](std::size_t i) { projected[i] = interpolate(mesh, points, i, column); }, 8192);
    }
}

void CpuPixelProjection::curvature(const HatchingSurface& surface, const HatchingView& view, const FacePoints& points,
                                   std::span<const std::uint32_t> which, std::span<float> out) {
    check_curvature(surface, points, which, out);
    if (which.empty()) return;
    scalars(surface.mesh, points, view_curvature_features(surface, view), which, out);
}

void CpuPixelProjection::directions(const TriangleMesh& mesh, const HatchingView& view, const FacePoints& points,
                                    std::span<const std::span<const Vec3>> fields, std::span<DoubledAngle> out) {
    check_directions(mesh, points, fields, out);
    const Eigen::Matrix4f view_projection = view.camera.view_projection();
    parallel_for(
        points.size(),
        [&](std::size_t i) {
            const Vec3 point = interpolate(mesh, points, i, mesh.vertices);
            for (std::size_t k = 0; k < fields.size(); ++k) {
                const Vec3 direction = interpolate_direction(mesh, points, i, fields[k]);
                out[k * points.size() + i] =
                    doubled_angle(projected_direction(view, view_projection, point, direction).stableNormalized());
            }
        },
        512);
}

}  // namespace exemplar
