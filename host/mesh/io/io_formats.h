#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "host/mesh/io/io.h"

/// The reader of each format. `content` is the whole file, `name` its path for error messages (MeshError).
namespace exemplar::mesh_io {

MeshFile read_off(std::string_view content, const std::string& name);
MeshFile read_obj(std::string_view content, const std::string& name);
MeshFile read_ply(std::string_view content, const std::string& name);
MeshFile read_stl(std::string_view content, const std::string& name);
/// .gltf (JSON) or .glb (binary), told apart by content. `folder` is where buffers in files of their own are looked
/// for.
MeshFile read_gltf(std::string_view content, const std::string& name, const std::filesystem::path& folder);

/// Throws UsageError unless `labels` has one label in [-1, names) per source face, and DataError unless every name can
/// be written in a line of text: UTF-8, not empty, no control characters, no space at either end, no byte order mark in
/// front, not several numbers.
void check_labels(const TriangleMesh& mesh, const FaceLabels& labels);
void check_label_names(const FaceLabels& labels);
/// Whether `name` is one that check_label_names takes; readers refuse any other.
bool is_label_name(std::string_view name);
/// Number of source faces, also of meshes of triangles only whose source_face_count nobody set.
std::size_t source_faces(const TriangleMesh& mesh);

}  // namespace exemplar::mesh_io
