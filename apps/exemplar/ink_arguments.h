#pragma once

#include <filesystem>

#include "apps/help/command.h"
#include "host/lines/part_inks.h"
#include "host/mesh/io/io.h"
#include "host/parts/materials/material_table.h"

namespace exemplar {

/// Arguments of drawings whose parts have inks of their own.
struct InkArguments {
    std::filesystem::path labels;     ///< of the mesh's faces; empty: those in its file or beside it
    std::filesystem::path materials;  ///< what the labels look like; empty: all faces are drawn alike
};

/// Adds --materials.
void add_materials_option(Command& command, std::filesystem::path& materials);

/// Checks what can be checked before any work; throws UsageError or DataError.
void require_inks(const InkArguments& arguments);

/// Returns the inks of a mesh that was read from `path`; none without materials. `ink` says which ink of a material
/// counts. Throws DataError or UsageError, naming the file at fault.
PartInks read_inks(const InkArguments& arguments, const std::filesystem::path& path, const MeshFile& file,
                   PartInk PartMaterial::*ink);

}  // namespace exemplar
