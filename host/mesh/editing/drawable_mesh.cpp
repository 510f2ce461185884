#include "host/mesh/editing/drawable_mesh.h"

#include <fmt/format.h>

#include <utility>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/editing/weld.h"

namespace exemplar {

std::size_t remove_collapsed_faces(TriangleMesh& mesh) {
    std::vector<Face> faces;
    std::vector<std::uint32_t> source_face;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const auto& [a, b, c] = mesh.faces[f];
        if (a == b || b == c || c == a) continue;
        faces.push_back(mesh.faces[f]);
        source_face.push_back(mesh.source_of(f));
    }
    const std::size_t removed = mesh.face_count() - faces.size();
    if (removed == 0) return 0;
    mesh.faces = std::move(faces);
    mesh.source_face = std::move(source_face);
    return removed;
}

DrawableMesh drawable_mesh(const TriangleMesh& mesh, const std::string& name) {
    const MeshReport report = require_usable(mesh, name);
    DrawableMesh drawable{welded(mesh), {}};
    const std::size_t removed = remove_collapsed_faces(drawable.mesh);
    if (drawable.mesh.faces.empty())
        throw MeshError(name + ": every face has two corners at one place; there is nothing to draw");
    if (removed > 0)
        drawable.warnings.push_back(
            fmt::format("{} left out, two of whose corners are at one place", counted(removed, "face")));
    if (report.inside_out) {
        for (Face& face : drawable.mesh.faces) std::swap(face[1], face[2]);
        drawable.warnings.emplace_back("the surface is inside out; its faces were turned around");
    }
    return drawable;
}

}  // namespace exemplar
