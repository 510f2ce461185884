#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "host/mesh/io/io.h"

/// The readers of the formats. `content` is the whole file, `name` its path for error messages (MeshError).
namespace exemplar::mesh_io {

MeshFile read_off(std::string_view content, const std::string& name);
MeshFile read_obj(std::string_view content, const std::string& name);
MeshFile read_ply(std::string_view content, const std::string& name);
MeshFile read_stl(std::string_view content, const std::string& name);
/// Reads .gltf (JSON) or .glb (binary), told apart by content. Looks for external buffers in `folder`. This and the
/// next function are those of host/mesh/gltf.
MeshFile read_gltf(std::string_view content, const std::string& name, const std::filesystem::path& folder);
/// Returns the total size of the external buffers that the JSON of a .gltf file declares. Throws MeshError.
std::uint64_t gltf_external_buffer_bytes(std::string_view json, const std::string& name);

/// check_labels throws UsageError unless `labels` has one label in [-1, names) per source face. Both throw DataError
/// unless every name fits on a line of text: UTF-8, not empty, no control characters, no space at either end, no
/// byte order mark in front, not several numbers.
void check_labels(const TriangleMesh& mesh, const FaceLabels& labels);
void check_label_names(const FaceLabels& labels);
/// Returns whether check_label_names accepts `name`; readers refuse any other.
bool is_label_name(std::string_view name);
/// Returns the number of source faces, also of meshes of triangles only whose source_face_count nobody set.
std::size_t source_faces(const TriangleMesh& mesh);

}  // namespace exemplar::mesh_io
