#include "gpu/lines/line_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "gpu/curvature/surface/texels.h"
#include "host/core/errors.h"
#include "host/mesh/topology.h"
#include "shaders/shared/lines.h"

namespace exemplar {

static_assert(k_no_neighbor == shared::k_boundary_side && k_blocked_side == shared::k_blocked_side &&
              k_sharp_side == shared::k_sharp_side && k_crowded_side == shared::k_crowded_side &&
              k_max_neighbor_code == shared::k_max_side_code);
static_assert(k_at_corner == shared::k_place_corner && k_inside_face == shared::k_place_inside);

namespace {

std::vector<shared::uvec4> padded(std::span<const std::array<std::uint32_t, 3>> faces) {
    std::vector<shared::uvec4> result;
    result.reserve(faces.size());
    for (const auto& [a, b, c] : faces) result.push_back({a, b, c, 0});
    return result;
}

}  // namespace

GpuLineSurface::GpuLineSurface(const GpuSurface& surface)
    : GpuLineSurface(surface, build_face_neighbors(surface.rest().faces, surface.rest().vertices),
                     surface.rest().faces) {}

GpuLineSurface::GpuLineSurface(const GpuSurface& surface, std::span<const FaceNeighbors> neighbors,
                               std::span<const Face> joined)
    : surface_(&surface) {
    TriangleMesh mesh;
    mesh.faces.assign(joined.begin(), joined.end());
    mesh.vertices.resize(surface.rest().vertex_count());
    if (neighbors.size() != surface.face_count() || joined.size() != surface.face_count())
        throw UsageError(fmt::format("neighbors of {} and corners of {} faces for {}: compute them for the same mesh",
                                     neighbors.size(), joined.size(), surface.face_count()));
    check_texels(surface.device(), 3 * mesh.face_count(), "the faces around the vertices of a surface");
    for (const FaceNeighbors& sides : neighbors)
        closed_ = closed_ && std::ranges::find(sides, k_no_neighbor) == sides.end();
    const Topology topology = build_topology(mesh);
    neighbors_ = Buffer::of<shared::uvec4>(surface.device(), padded(neighbors));
    joined_faces_ = Buffer::of<shared::uvec4>(surface.device(), padded(joined));
    face_begin_ = Buffer::of<std::uint32_t>(surface.device(), topology.vertex_face_begin);
    vertex_faces_ = Buffer::of<std::uint32_t>(surface.device(), topology.vertex_faces);
}

std::uint32_t line_families(std::span<const LineType> types) {
    std::uint32_t families = 0;
    for (std::uint32_t family = 0; family < shared::k_line_families; ++family)
        for (const LineType type : types)
            if (type_of_family(family) == type) families |= 1u << family;
    return families;
}

LineType type_of_family(std::uint32_t family) {
    switch (family) {
        case shared::k_contours:
        case shared::k_edge_contours:
            return LineType::contours;
        case shared::k_suggestive_contours:
            return LineType::suggestive_contours;
        case shared::k_suggestive_highlights:
            return LineType::suggestive_highlights;
        case shared::k_ridges:
            return LineType::ridges;
        case shared::k_valleys:
            return LineType::valleys;
        case shared::k_apparent_ridges:
            return LineType::apparent_ridges;
        case shared::k_creases:
            return LineType::creases;
        case shared::k_boundaries:
            return LineType::boundaries;
        default:
            return LineType::principal_highlights;
    }
}

}  // namespace exemplar
