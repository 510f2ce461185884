#include "host/parts/prototype/print_solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/editing/weld.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace {

/// Pieces of a solid with less than this share of its volume are crumbs.
constexpr double k_crumb_share = 0.02;

}  // namespace

TriangleMesh closed_for_print(const TriangleMesh& mesh) {
    TriangleMesh closed = welded(mesh);
    const MeshReport report = require_usable(closed, "the mesh");
    if (report.boundary_edges > 0)
        throw MeshError(
            fmt::format("its surface is open at {} edges; solids need a closed surface", report.boundary_edges));
    return closed;
}

TriangleMesh without_crumbs(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> component = face_components(mesh, build_topology(mesh));
    std::vector<double> volume;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (component[f] >= volume.size()) volume.resize(component[f] + 1, 0);
        const Face& face = mesh.faces[f];
        volume[component[f]] +=
            static_cast<double>(mesh.vertices[face[0]].cross(mesh.vertices[face[1]]).dot(mesh.vertices[face[2]])) / 6;
    }
    const double largest = volume.empty() ? 0 : *std::max_element(volume.begin(), volume.end());
    TriangleMesh kept;
    std::vector<std::uint32_t> number(mesh.vertex_count(), k_invalid_index);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (std::abs(volume[component[f]]) < k_crumb_share * largest) continue;
        Face face = mesh.faces[f];
        for (std::uint32_t& v : face) {
            if (number[v] == k_invalid_index) {
                number[v] = static_cast<std::uint32_t>(kept.vertices.size());
                kept.vertices.push_back(mesh.vertices[v]);
            }
            v = number[v];
        }
        kept.faces.push_back(face);
    }
    kept.source_face_count = static_cast<std::uint32_t>(kept.faces.size());
    return kept;
}

}  // namespace exemplar
