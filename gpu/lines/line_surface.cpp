#include "gpu/lines/line_surface.h"

#include <vector>

#include "gpu/curvature/surface/texels.h"
#include "host/mesh/topology.h"
#include "shaders/shared/lines.h"

namespace exemplar {

static_assert(k_no_neighbor == shared::k_boundary_side && k_nonmanifold_neighbors == shared::k_nonmanifold_side &&
              k_max_neighbor_code == shared::k_max_side_code);
static_assert(k_at_corner == shared::k_place_corner && k_inside_face == shared::k_place_inside);

GpuLineSurface::GpuLineSurface(const GpuSurface& surface) : surface_(&surface) {
    const TriangleMesh& mesh = surface.rest();
    check_texels(surface.device(), 3 * mesh.face_count(), "the faces around the vertices of a surface");
    std::vector<shared::uvec4> neighbors;
    neighbors.reserve(mesh.face_count());
    for (const auto& [a, b, c] : build_face_neighbors(mesh.faces, mesh.vertex_count())) {
        neighbors.push_back({a, b, c, 0});
        closed_ = closed_ && a != k_no_neighbor && b != k_no_neighbor && c != k_no_neighbor;
    }
    const Topology topology = build_topology(mesh);
    neighbors_ = Buffer::of<shared::uvec4>(surface.device(), neighbors);
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
