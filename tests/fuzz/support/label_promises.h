#pragma once

#include <cstddef>
#include <filesystem>

namespace exemplar::fuzz {

/// Reads a file of labels (see read_face_labels) of a mesh of two quads and a triangle on seven vertices, writes them
/// in every form, and reads these again. Returns whether the file was accepted; throws BrokenPromise. `size`: of the
/// file.
bool keeps_label_promises(const std::filesystem::path& path, std::size_t size);

/// Divides the triangles of a glTF file that read_mesh accepts into three parts, and reads the written file again.
bool keeps_split_promises(const std::filesystem::path& path, std::size_t size);

}  // namespace exemplar::fuzz
