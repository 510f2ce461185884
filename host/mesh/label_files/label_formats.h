#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "host/mesh/io/io.h"
#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

/// The readers and writers behind label_files.h. `content` is the whole file, `name` its path for messages (DataError).
namespace exemplar::label_files {

/// Throws DataError "NAME: MESSAGE".
[[noreturn]] void fail(const std::string& name, const std::string& message);

/// Makes labels of source faces from one number per source face, or else per vertex; -1 is unlabeled. The numbers that
/// occur become labels in ascending order, named by `names` if that has one for each of them, else by themselves.
/// Throws DataError if their count is that of neither.
FaceLabels labels_of_numbers(const std::vector<std::int64_t>& numbers, const std::vector<std::string>& names,
                             const TriangleMesh& mesh, const std::string& name);

/// Returns whether each line of a text, blank ones aside, is one integer.
bool is_number_list(std::string_view content);
FaceLabels read_number_list(std::string_view content, const TriangleMesh& mesh, const std::string& name);
/// Reads a segment number or a name per face and line. `names`: those of the numbers, may be empty.
FaceLabels read_segments(std::string_view content, const std::vector<std::string>& names, const TriangleMesh& mesh,
                         const std::string& name);
/// Reads a name per line. Throws for one that no label can have.
std::vector<std::string> read_name_lines(std::string_view content, const std::string& name);

FaceLabels read_json_labels(std::string_view content, const TriangleMesh& mesh, const std::string& name);
FaceLabels read_npy_labels(std::string_view content, const TriangleMesh& mesh, const std::string& name);
FaceLabels read_vtp_labels(std::string_view content, const TriangleMesh& mesh, const std::string& name);
/// Reads the groups, materials or objects of an OBJ file. Faces before the first name have no label.
FaceLabels read_obj_groups(std::string_view content, const TriangleMesh& mesh, const std::string& name);
/// Whether the joints of a skin are labels.
enum class GltfJoints { are_labels, are_none };
/// Reads the numbers of vertices in a glTF file (see GltfSurface::vertex_values), else the names of its materials,
/// else, if there are fewer than two and joints are labels, those of the joints with the largest weight on each
/// triangle. Unnamed ones are named by their numbers.
FaceLabels read_gltf_labels(std::string_view content, const std::filesystem::path& folder, const TriangleMesh& mesh,
                            const std::string& name, GltfJoints joints);

std::string json_of_labels(const TriangleMesh& mesh, const FaceLabels& labels);
std::string json_of_vertices(const TriangleMesh& mesh, const FaceLabels& labels);
std::string npy_of_labels(const FaceLabels& labels);
std::string vtp_of_labels(const MeshFile& file, const FaceLabels& labels);

}  // namespace exemplar::label_files
