#include "host/synth/modeling/surface.h"

#include <algorithm>
#include <cmath>

#include "host/mesh/topology.h"
#include "host/synth/modeling/polygonize.h"
#include "host/synth/modeling/remesh.h"

namespace exemplar {

TriangleMesh fine_mesh(const ImplicitField& field, float detail, std::size_t faces) {
    TriangleMesh mesh = polygonize(field, detail);
    const double wanted = 2.5 * static_cast<double>(faces), got = static_cast<double>(mesh.face_count());
    if (got < wanted) mesh = polygonize(field, detail * static_cast<float>(std::sqrt(got / wanted)));
    return mesh;
}

int genus_of(const TriangleMesh& mesh) {
    // V vertices have F = 2 (V - 2 + 2 genus) faces.
    const auto v = static_cast<long>(mesh.vertex_count()), f = static_cast<long>(mesh.face_count());
    return static_cast<int>((f / 2 - v + 2) / 2);
}

bool is_one_component(const TriangleMesh& mesh) {
    return !mesh.faces.empty() && std::ranges::max(face_components(mesh, build_topology(mesh))) == 0;
}

TriangleMesh mesh_surface(const ImplicitField& field, float detail, std::size_t vertices) {
    const std::size_t faces = 2 * (std::max<std::size_t>(vertices, 4) - 2);
    return remesh(fine_mesh(field, detail, faces), field, faces);
}

}  // namespace exemplar
