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

/// Returns whether the extension is that of a mesh file.
bool is_mesh_file(const std::filesystem::path& path);

/// Whether meshes that a list names but that do not exist are an error.
enum class MissingMeshes { refused, kept };

/// Returns the mesh paths of `source`: a mesh file itself, a folder (its mesh files in natural order, without
/// subfolders) or a text file with a path per line (relative to the working folder or to the list's; a '#' at the
/// start or after a space begins a comment). Throws DataError if there are none, or if one in a list does not exist,
/// unless those are kept.
std::vector<std::filesystem::path> list_meshes(const std::filesystem::path& source,
                                               MissingMeshes missing = MissingMeshes::refused);

/// Returns the path of a mesh's labels: NAME_labels.txt beside it, or in `labels_folder` if one is given.
std::filesystem::path labels_path(const std::filesystem::path& mesh, const std::filesystem::path& labels_folder = {});

/// Returns the labels of the source faces of a mesh that was read from `path`, from wherever load_corpus finds them.
/// Throws DataError if there are none.
FaceLabels labels_of_mesh(const std::filesystem::path& path, const MeshFile& file,
                          const std::filesystem::path& labels_folder = {});

/// Reads meshes with their labels: from NAME_labels.txt beside NAME.off (any mesh format), else from the PLY's own
/// label property, else from files of other programs (see find_other_labels). With a `labels_folder`, reads only
/// NAME_labels.txt there, so that the same meshes can have labels of another style. Labels of equal names are one
/// label, whichever meshes they come from. With `names`, any other label is an error. Throws DataError naming a mesh
/// without labels and what would be accepted, or an unknown label and the nearest known one.
LabeledCorpus load_corpus(const std::vector<std::filesystem::path>& paths, const std::vector<std::string>& names = {},
                          const std::filesystem::path& labels_folder = {});

/// Returns the corpus with these label names, in this order, and after them those of its own that are not among them.
LabeledCorpus with_label_order(LabeledCorpus corpus, std::vector<std::string> names);

/// Returns labels of the source faces from labels of their triangles. Each polygon gets the label with the most
/// area; one without triangles gets that of its neighbor in the file.
std::vector<std::int32_t> to_source_faces(const TriangleMesh& mesh, std::span<const std::int32_t> triangle_label);

}  // namespace exemplar
