#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/mesh/io/io.h"
#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A mesh with a label per triangle, as training and evaluation use it.
struct LabeledMesh {
    std::string name;  ///< file name without extension
    std::filesystem::path path;
    TriangleMesh mesh;
    std::vector<std::int32_t> label;  ///< per triangle, index into the corpus' names; -1 where unlabeled
};

struct LabeledCorpus {
    std::vector<std::string> names;  ///< label names: those given, else sorted
    std::vector<LabeledMesh> meshes;
    std::vector<std::string> warnings;
};

/// Whether the name ends as that of a mesh.
bool is_mesh_file(const std::filesystem::path& path);

/// What is done with meshes that a list names and that are not there.
enum class MissingMeshes { refused, kept };

/// Mesh paths of `source`: a mesh file itself, a folder (its mesh files in natural order, not below) or a text file
/// with a path a line (relative to the working folder or to the list's; a '#' at the start or after a space begins a
/// comment). Throws DataError when there are none, or one of a list is not there, unless such are kept.
std::vector<std::filesystem::path> list_meshes(const std::filesystem::path& source,
                                               MissingMeshes missing = MissingMeshes::refused);

/// Where the labels of a mesh are: NAME_labels.txt beside it, or in `labels_folder` if one is given.
std::filesystem::path labels_path(const std::filesystem::path& mesh, const std::filesystem::path& labels_folder = {});

/// Reads meshes with their labels: from NAME_labels.txt beside NAME.off (any mesh format), else from the PLY's own
/// label property; with a `labels_folder` only from NAME_labels.txt there, so that the same meshes can have labels of
/// another style. Throws DataError naming the mesh that has no labels and what would be accepted; `names` adds known
/// labels (a label that is not among them is an error with the nearest suggestion, unless names is empty). Labels of
/// equal names are one label, whichever meshes they come from.
LabeledCorpus load_corpus(const std::vector<std::filesystem::path>& paths, const std::vector<std::string>& names = {},
                          const std::filesystem::path& labels_folder = {});

/// Labels of the source faces from labels of their triangles (each polygon gets the label with the most area; one
/// without triangles that of its neighbor in the file).
std::vector<std::int32_t> to_source_faces(const TriangleMesh& mesh, std::span<const std::int32_t> triangle_label);

}  // namespace exemplar
