#include "apps/exemplar/parts/solid_output.h"

#include <fmt/format.h>

#include <cctype>
#include <set>
#include <string>

#include "host/mesh/editing/validate.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

/// A file name for a solid: labels may hold any text. Other characters than letters, digits, - and _ become _, and a
/// name that is taken gets a number.
std::string file_of_solid(const std::string& name, std::set<std::string>& taken) {
    std::string stem = name.substr(0, 100);
    for (char& c : stem)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
    std::string file = stem;
    for (int i = 2; !taken.insert(file).second; ++i) file = fmt::format("{}_{}", stem, i);
    return file + ".stl";
}

}  // namespace

nlohmann::json write_solids(const std::vector<PrintSolid>& parts, const std::filesystem::path& folder) {
    nlohmann::json solids = nlohmann::json::array();
    TriangleMesh all;
    std::set<std::string> taken{"all"};
    for (const PrintSolid& solid : parts) {
        const std::string file = file_of_solid(solid.name, taken);
        write_stl(folder / file, solid.mesh);
        const auto first = static_cast<std::uint32_t>(all.vertices.size());
        all.vertices.insert(all.vertices.end(), solid.mesh.vertices.begin(), solid.mesh.vertices.end());
        for (const Face& face : solid.mesh.faces)
            all.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
        const MeshReport report = validate_mesh(solid.mesh);
        const bool is_closed = report.boundary_edges == 0 && report.non_manifold_edges.empty() && !report.inside_out;
        solids.push_back({{"solid", solid.name},
                          {"file", file},
                          {"faces", solid.mesh.face_count()},
                          {"pieces", report.components},
                          {"closed", is_closed}});
    }
    write_stl(folder / "all.stl", all);
    return solids;
}

}  // namespace exemplar
