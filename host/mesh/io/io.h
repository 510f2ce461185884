#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// What a mesh file held.
struct MeshFile {
    TriangleMesh mesh;
    /// Per source face, from a PLY `label` property (names from `comment label INDEX NAME` lines, else the numbers), or
    /// from the material names of a glTF file that Exemplar wrote. Absent in all other files.
    std::optional<FaceLabels> labels;
    /// Per source face, from a PLY float property `confidence` (see write_ply): as read, NaN for triangles of strips.
    /// Empty in all other files.
    std::vector<float> confidence;
    /// One-line remarks about what was repaired or left out while reading.
    std::vector<std::string> warnings;
};

/// Reads OFF, OBJ, PLY (ascii, binary little and big endian), STL (ascii, binary) or glTF 2.0 (.gltf, .glb), by
/// extension and checked against content. Polygons are cut into triangles. Vertices of STL and of glTF seams are welded
/// by exact position; each triangle of a PLY triangle strip is a source face, without a label; of glTF the triangles of
/// the default scene are read, with the transforms of their nodes. Coordinates that are not finite are read as they are
/// (see validate_mesh). Throws MeshError with file and line (or byte) for anything malformed; never allocates more than
/// a small multiple of the file's size.
MeshFile read_mesh(const std::filesystem::path& path);

/// How many bytes a .gltf file says to have in files beside it; 0 for any other file, and for one that is damaged.
std::uint64_t bytes_beside(const std::filesystem::path& path);

/// Extensions that read_mesh takes, lower case with dot.
std::span<const std::string_view> mesh_extensions();

/// The writers write triangles, in the order of `mesh` unless said otherwise, and replace a file only when the new one
/// is complete. They throw DataError where they cannot write, UsageError where labels do not fit the mesh.
void write_off(const std::filesystem::path& path, const TriangleMesh& mesh);
void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh);
/// Binary little-endian PLY with, if given, per face an int property `label` and uchar red, green, blue
/// (`comment label INDEX NAME` lines name them) and a float `confidence`. Labels and confidences are per source face of
/// `mesh`; each triangle is written with those of its source face, -1 and gray where unlabeled.
void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, const FaceLabels* labels = nullptr,
               std::span<const float> confidence = {});
/// Binary glTF (.glb) with one primitive and one named, colored material per label that occurs, so triangles are in
/// order of label; unlabeled ones come first, with a gray material without a name. Throws MeshError if a vertex is not
/// finite or there are no faces, neither of which glTF can say.
void write_gltf(const std::filesystem::path& path, const TriangleMesh& mesh, const FaceLabels& labels);

/// The benchmark's form: a line with the label name, a line of 1-based face indices. Labels without faces are left out.
/// Throws DataError if a face is unlabeled.
void write_labels_txt(const std::filesystem::path& path, const FaceLabels& labels);
/// Reads that form; throws DataError with file and line where a face is unlabeled, labeled twice or out of range.
FaceLabels read_labels_txt(const std::filesystem::path& path, std::size_t face_count);
/// One 0-based SEGMENT index per face and line: connected components of equal label, numbered in order of first face.
/// Faces are the source faces of `mesh`; two are connected if they share an edge.
void write_seg(const std::filesystem::path& path, const TriangleMesh& mesh, const FaceLabels& labels);
/// Reads a .seg file: one non-negative integer per face.
std::vector<std::int32_t> read_seg(const std::filesystem::path& path, std::size_t face_count);

}  // namespace exemplar
