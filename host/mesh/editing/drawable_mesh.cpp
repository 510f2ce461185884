#include "host/mesh/editing/drawable_mesh.h"

#include <fmt/format.h>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/mesh/editing/merge_coincident_faces.h"
#include "host/mesh/editing/orient_faces.h"
#include "host/mesh/editing/remove_faces.h"
#include "host/mesh/editing/remove_flat_faces.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/editing/weld.h"

namespace exemplar {

void warn_of_coincident_faces(std::size_t removed, std::vector<std::string>& warnings) {
    if (removed > 0)
        warnings.push_back(
            fmt::format("{} on others; one of each was kept", counted(removed, "face lies", "faces lie")));
}

void warn_of_turned_faces(const OrientationChange& change, std::vector<std::string>& warnings) {
    if (change.turned_faces > 0)
        warnings.push_back(
            fmt::format("{} turned around to agree with neighboring faces", counted(change.turned_faces, "face")));
    if (change.turned_pieces == 0) return;
    if (change.pieces == 1)
        warnings.emplace_back("the surface is inside out; its faces were turned around");
    else
        warnings.push_back(fmt::format("{} of {} connected pieces {} inside out; {} faces were turned around",
                                       change.turned_pieces, change.pieces, change.turned_pieces == 1 ? "was" : "were",
                                       change.turned_pieces == 1 ? "its" : "their"));
}

DrawableMesh drawable_mesh(const TriangleMesh& mesh, const std::string& name) {
    require_drawable(mesh, name);
    DrawableMesh drawable{welded(mesh), {}};
    const std::size_t removed = remove_collapsed_faces(drawable.mesh);
    if (drawable.mesh.faces.empty())
        throw MeshError(name + ": every face has two corners at one place; there is nothing to draw");
    if (removed > 0)
        drawable.warnings.push_back(
            fmt::format("{} left out, two of whose corners are at one place", counted(removed, "face")));
    std::size_t coincident = merge_coincident_faces(drawable.mesh);
    if (const std::size_t flat = remove_flat_faces(drawable.mesh); flat > 0) {
        drawable.warnings.push_back(fmt::format("{} without area left out", counted(flat, "face")));
        coincident += merge_coincident_faces(drawable.mesh);
    }
    if (drawable.mesh.faces.empty()) throw MeshError(name + ": no face has an area; there is nothing to draw");
    warn_of_coincident_faces(coincident, drawable.warnings);
    warn_of_turned_faces(orient_faces(drawable.mesh), drawable.warnings);
    return drawable;
}

}  // namespace exemplar
