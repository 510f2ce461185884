#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "host/mesh/io/io.h"

namespace exemplar::mesh_io {

/// The output of exemplar-import.
enum class ImportContent {
    still,      ///< the meshes at rest, as PLY
    animation,  ///< the scene with its skins, morph targets and animations, as binary glTF
};

/// Returns whether exemplar-import reads files with this extension (lower case, with dot).
bool is_imported(std::string_view extension);

/// Has the program exemplar-import read a file with the Open Asset Import Library (FBX, COLLADA, 3MF, 3DS), and returns
/// what it wrote. The program lies beside this one, in the folder above, or in PATH. It bounds its memory and processor
/// time, and is ended after five times as long or if it writes far more than such a file holds. Throws MeshError naming
/// `path` if the file cannot be read, if the process crashed or met a bound, and if there is no such program (Exemplar
/// was built without the library).
std::string run_import(const std::filesystem::path& path, ImportContent wanted);

/// When run_import() ends the program.
struct ImportBounds {
    std::chrono::milliseconds time;  ///< from its start
    std::uint64_t bytes;             ///< of output
};

/// Has `program` (a path, or a name in PATH) read the file in place of exemplar-import, within `bounds`. Returns and
/// throws what the other run_import() does.
std::string run_import(const std::filesystem::path& path, ImportContent wanted, const std::string& program,
                       const ImportBounds& bounds);

/// Takes the lines of warnings from the front of what exemplar-import wrote.
std::vector<std::string> take_import_warnings(std::string_view& output);

/// Reads what exemplar-import wrote of the file `name` as a still. Vertices at equal positions are joined. The output
/// is checked like a file from elsewhere. Throws MeshError that begins with `name`.
MeshFile mesh_of_import(std::string_view output, const std::string& name);

}  // namespace exemplar::mesh_io
