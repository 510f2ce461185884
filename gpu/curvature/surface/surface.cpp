#include "gpu/curvature/surface/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "gpu/curvature/surface/texels.h"
#include "gpu/curvature/surface/vertex_rings.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

float edge_scale(const TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.faces) {
        const auto at = [&](std::uint32_t v) -> Vec3d { return mesh.vertices[v].cast<double>(); };
        sum += (at(b) - at(a)).norm() + (at(c) - at(b)).norm() + (at(a) - at(c)).norm();
    }
    const double mean = sum / (3.0 * static_cast<double>(mesh.face_count()));
    if (!(mean > 0) || !std::isfinite(mean)) return 1.0f;
    return static_cast<float>(std::exp2(std::clamp(std::round(-std::log2(mean)), -100.0, 100.0)));
}

std::vector<shared::uvec4> corners_of(const TriangleMesh& mesh) {
    std::vector<shared::uvec4> corners;
    corners.reserve(mesh.face_count());
    for (const auto& [a, b, c] : mesh.faces) corners.push_back({a, b, c, 0});
    return corners;
}

// Checks that kernels can visit each ring in one loop.
void check_rings(const VertexRings& rings) {
    for (std::size_t v = 0; v < rings.begin.size(); ++v) {
        const std::size_t end = v + 1 < rings.begin.size() ? rings.begin[v + 1] : rings.texels.size();
        const std::size_t corners = 4 * (end - rings.begin[v]);
        if (corners > k_max_iterations)
            throw DeviceLimitError(fmt::format("vertex {} has some {} faces around it, and kernels go around {} at "
                                               "most; simplify the mesh",
                                               v, corners, k_max_iterations),
                                   corners, k_max_iterations);
    }
}

}  // namespace

GpuSurface::GpuSurface(Device& device, TriangleMesh rest)
    : device_(&device),
      rest_(std::move(rest)),
      vertex_count_(static_cast<std::uint32_t>(rest_.vertex_count())),
      face_count_(static_cast<std::uint32_t>(rest_.face_count())),
      scale_(1.0f) {
    const VertexRings rings = build_vertex_rings(rest_);
    check_rings(rings);
    check_texels(device, std::max<std::size_t>(rings.texels.size(), face_count_), "the faces of a surface");
    scale_ = edge_scale(rest_);
    faces_ = Buffer::of<shared::uvec4>(device, corners_of(rest_));
    indices_ = Buffer::of<Face>(device, rest_.faces);
    ring_begin_ = Buffer::of<std::uint32_t>(device, rings.begin);
    rings_ = Buffer::of<shared::uvec4>(device, rings.texels);
}

void GpuSurface::check_vertices(const Buffer& vertices) const {
    const std::size_t wanted = std::size_t{vertex_count_} * sizeof(shared::vec4);
    if (vertices.bytes() != wanted)
        throw UsageError(fmt::format("a surface of {} vertices needs vertices of {} bytes, not {}; pose its own mesh",
                                     vertex_count_, wanted, vertices.bytes()));
}

}  // namespace exemplar
