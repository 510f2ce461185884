#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/help/command.h"
#include "host/mesh/io/io.h"

namespace exemplar {

/// How commands write the parts of a labeled mesh.
struct PartOptions {
    std::string format = "glb";
    bool caps = false, instances = false;
    double explode = 0;  ///< share of the diagonal
};

/// Adds --caps, --explode and --instances.
void add_part_options(Command& command, PartOptions& options);
/// Throws UsageError for an unknown format, or a share that is negative or not finite.
void check_part_options(const PartOptions& options);

/// Writes the parts of the mesh, whose labels are per source face, as STEM_PART.EXTENSION or STEM.glb. Returns their
/// description for reports (see docs/formats.md); "files" are the files. Of a glTF mesh, a .glb file without caps keeps
/// textures, skins, morph targets and animations (see split_gltf).
nlohmann::json write_part_files(const std::filesystem::path& stem, const std::filesystem::path& mesh_path,
                                const MeshFile& file, const FaceLabels& labels, const PartOptions& options);

}  // namespace exemplar
