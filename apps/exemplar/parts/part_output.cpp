#include "apps/exemplar/parts/part_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/mesh/gltf/gltf_split.h"
#include "host/parts/splitting/part_check.h"
#include "host/parts/splitting/part_files.h"

namespace exemplar {
namespace {

nlohmann::json describe_part(const std::string& name, const std::string& label, const PartMesh& part) {
    const PartCheck check = check_part(part.mesh);
    return {{"name", name},
            {"label", label},
            {"triangles", part.mesh.face_count()},
            {"cap_triangles", part.cap_faces},
            {"closed", check.is_closed()},
            {"manifold", check.is_manifold()},
            {"volume", check.volume}};
}

nlohmann::json describe_split(const TriangleMesh& mesh, const MeshParts& names, const FaceLabels& labels,
                              const SplitMesh& split) {
    const PartCheck whole = check_part(mesh);
    nlohmann::json parts = nlohmann::json::array();
    double volume = 0;
    for (std::size_t p = 0; p < split.parts.size(); ++p) {
        const std::int32_t label = names.labels[p];
        const std::string word = label < 0 ? std::string() : labels.names[static_cast<std::size_t>(label)];
        parts.push_back(describe_part(names.names[p], word, split.parts[p]));
        volume += parts.back()["volume"].get<double>();
    }
    const bool comparable = whole.is_closed() && whole.volume != 0;
    return {{"parts", parts},
            {"closed", whole.is_closed()},
            {"manifold", whole.is_manifold()},
            {"volume", whole.volume},
            {"volume_defect", comparable ? nlohmann::json(std::abs(volume / whole.volume - 1)) : nlohmann::json()},
            {"caps", split.caps},
            {"cap_centers", split.cap_centers},
            {"open_cut_edges", split.open_edges}};
}

}  // namespace

void add_part_options(Command& command, PartOptions& options) {
    command.add_flag("--caps", options.caps, "close the cuts, so that the parts of a closed mesh are closed");
    command.add_option("--explode", options.explode, "move parts apart, by up to this share of the mesh's diagonal")
        ->capture_default_str()
        ->type_name("SHARE");
    command.add_flag("--instances", options.instances,
                     "a part per connected piece of a label: leg_1, leg_2, or leg_left, leg_right");
}

void check_part_options(const PartOptions& options) {
    if (std::ranges::find(part_formats(), options.format) == part_formats().end())
        throw UsageError(
            fmt::format("parts are written as {}, not as '{}'", fmt::join(part_formats(), ", "), options.format));
    if (!(options.explode >= 0 && options.explode <= 100))
        throw UsageError(fmt::format("--explode takes a share from 0 to 100, not {}", options.explode));
}

nlohmann::json write_part_files(const std::filesystem::path& stem, const std::filesystem::path& mesh_path,
                                const MeshFile& file, const FaceLabels& labels, const PartOptions& options) {
    const TriangleMesh& mesh = file.mesh;
    const MeshParts names = options.instances ? parts_by_piece(mesh, labels) : parts_by_label(mesh, labels);
    const bool keeps_gltf =
        options.format == "glb" && is_gltf_file(mesh_path) && !options.caps && !(options.explode > 0);
    SplitMesh split = split_mesh(mesh, names.part_of_face, names.names.size(), {options.caps});
    nlohmann::json json = describe_split(mesh, names, labels, split);
    if (keeps_gltf) {
        json["files"] = {stem.string() + ".glb"};
        const SplitGltf gltf = split_gltf(mesh_path, names.part_of_face, names.names);
        json["warnings"] = gltf.warnings;
        write_file_atomically(stem.string() + ".glb", [&](std::ostream& out) { out << gltf.bytes; });
        return json;
    }
    if (is_gltf_file(mesh_path))
        json["warnings"] = {
            "the parts have no textures, skins or animations; only --format glb without --caps and --explode keeps "
            "them"};
    if (options.explode > 0) explode_parts(split.parts, options.explode);
    json["files"] = nlohmann::json::array();
    for (const std::filesystem::path& path : write_parts(stem, options.format, names, split.parts))
        json["files"].push_back(path.string());
    return json;
}

}  // namespace exemplar
