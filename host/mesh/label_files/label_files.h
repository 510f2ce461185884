#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/mesh/io/io.h"
#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Reads the labels of the source faces of a mesh, by the file's ending:
/// - .txt: a label file of the benchmark; or a list with a label of a face, or else of a vertex, per line, as numbers;
/// - .seg: a segment number per face and line, named in NAME.names (a name per line) or by their numbers; or a name per
///   face and line;
/// - .json: `labels`, a list of names, and `faces`, the index of one per face; or, as in 3DTeethSeg, `labels`, a number
///   per vertex;
/// - .npy: a one-dimensional array of integers, one per face, or else one per vertex;
/// - .vtp: an array of the cells: Label, Labels, MaterialIds, GroupIds, or the only one;
/// - .obj: groups, materials or objects (the first of these with two names); .gltf, .glb: the
///   vertex attribute _LABEL, _GROUP or _PART, else names of materials, else, if there are fewer than two, the joint
///   with the largest weight on each face: groups of vertices are exported so;
/// - other meshes: their labels.
/// Labels of vertices become those of faces as labels_of_faces tells. Throws DataError, with the file and the place, if
/// the file is malformed or of another number of faces.
FaceLabels read_face_labels(const std::filesystem::path& path, const TriangleMesh& mesh);

/// Returns the labels of a mesh file from files of other programs beside it (NAME_labels.json, NAME_labels.npy,
/// NAME.vtp, NAME.json, NAME.seg with names), or from its own groups or materials, if it has at least two; nothing if
/// there are none.
std::optional<FaceLabels> find_other_labels(const std::filesystem::path& mesh_path, const TriangleMesh& mesh);

/// The forms of write_label_file: json, npy, vtp, vertices, vertices-json.
std::span<const std::string_view> label_forms();

/// Writes labels per source face of the mesh of `file`:
/// - json: STEM_labels.json with `labels` (names), `faces` (per face an index, -1: unlabeled) and `instances` (per face
///   the number of its connected piece, from 0);
/// - npy: STEM_labels.npy, int32, one per face;
/// - vtp: STEM.vtp, VTK PolyData of the source faces with the cell array `Label` and the names in the field array
///   `LabelNames`; ParaView and vedo open it;
/// - vertices: STEM_vertices.txt, a label number per vertex and line;
/// - vertices-json: STEM_vertices.json with `labels` and `instances` per vertex, as 3DTeethSeg has them, and `names`.
///   If all names are numbers, labels are these numbers, else indices of names.
/// Labels of vertices are as labels_of_vertices tells. Returns the path. Throws UsageError for another form, or labels
/// that do not fit, DataError if the file cannot be written.
std::filesystem::path write_label_file(const std::filesystem::path& stem, std::string_view form, const MeshFile& file,
                                       const FaceLabels& labels);

}  // namespace exemplar
