#pragma once

#include <filesystem>

#include "host/mesh/io/io.h"

namespace exemplar::mesh_io {

/// Reads a format of the Open Asset Import Library (FBX, COLLADA, 3MF, 3DS) in a process of its own, the program
/// exemplar-import: it lies beside this program, in the folder above, or in PATH, and bounds its memory and time.
/// Vertices at equal positions are joined. Throws MeshError naming `path` if the file cannot be read, if the process
/// crashed or met a bound, and if there is no such program (Exemplar was built without the library).
MeshFile read_imported(const std::filesystem::path& path);

}  // namespace exemplar::mesh_io
