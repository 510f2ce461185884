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

/// Polygons as lists of vertex numbers.
struct Polygons {
    std::vector<std::uint32_t> corner_counts;  ///< per polygon; any number
    std::vector<std::uint32_t> corners;        ///< of one polygon after the other
};

/// The content of a mesh file.
struct MeshFile {
    TriangleMesh mesh;
    /// Per source face, from a PLY `label` property (names from `comment label INDEX NAME` lines, else the numbers), or
    /// from the material names of a glTF file that Exemplar wrote. Absent in all other files.
    std::optional<FaceLabels> labels;
    /// Per source face, from a PLY float property `confidence` (see write_ply): as read, NaN for triangles of strips.
    /// Empty in all other files.
    std::vector<float> confidence;
    /// The source faces as they are in the file, for write_ply. Empty if all are triangles.
    Polygons polygons;
    /// One-line remarks about what was repaired or left out while reading.
    std::vector<std::string> warnings;
};

/// Reads OFF, OBJ, PLY (ascii, binary little and big endian), STL (ascii, binary), glTF 2.0 (.gltf, .glb), or, through
/// the program exemplar-import, FBX, COLLADA (.dae), 3MF and 3DS. The
/// extension selects the format and is checked against the content. Cuts polygons into triangles; welds vertices of
/// STL and of glTF seams by exact position. Each triangle of a PLY triangle strip is a source face without a label.
/// Of glTF, reads the triangles of the default scene with the transforms of their nodes. Keeps coordinates that are
/// not finite (see validate_mesh). Throws MeshError with file and line (or byte) for anything malformed; never
/// allocates more than a small multiple of the file's size.
MeshFile read_mesh(const std::filesystem::path& path);

/// Returns how many bytes a .gltf file declares in files beside it; 0 for any other file, and for a damaged one.
std::uint64_t external_buffer_bytes(const std::filesystem::path& path);

/// Returns the extensions that read_mesh accepts, lower case with dot.
std::span<const std::string_view> mesh_extensions();

/// All writers write triangles, in the order of `mesh` unless said otherwise, in the file's frame (mesh.origin), and
/// replace a file only when the new one is complete. They throw DataError if they cannot write, UsageError if labels do
/// not fit the mesh.
void write_off(const std::filesystem::path& path, const TriangleMesh& mesh);
void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh);
/// Writes binary STL, rounded to floats, since STL holds no others. Throws MeshError if a vertex is not finite.
void write_stl(const std::filesystem::path& path, const TriangleMesh& mesh);
/// Writes binary little-endian PLY, with double coordinates if the mesh has an origin. If given, labels add per face an
/// int property `label` and uchar red, green, blue
/// (`comment label INDEX NAME` lines name them), and confidences a float `confidence`. Both are per source face of
/// `mesh`; each triangle is written with those of its source face, -1 and gray where unlabeled. If `polygons` are given
/// and not empty, they are written in place of the triangles: one per source face, of vertices of `mesh`.
void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, const FaceLabels* labels = nullptr,
               std::span<const float> confidence = {}, const Polygons* polygons = nullptr);
/// Writes binary glTF (.glb) with one primitive and one named, colored material per label that occurs, so triangles
/// are in order of label. Unlabeled ones come first, with an unnamed gray material. Throws MeshError if a vertex is
/// not finite or there are no faces: glTF can express neither.
void write_gltf(const std::filesystem::path& path, const TriangleMesh& mesh, const FaceLabels& labels);

/// Writes the benchmark's label file: per label a line with its name and a line of 1-based face indices. Leaves out
/// labels without faces. Throws DataError if a face is unlabeled.
void write_labels_txt(const std::filesystem::path& path, const FaceLabels& labels);
/// Reads a label file of the benchmark; throws DataError with file and line if a face is unlabeled, labeled twice or
/// out of range.
FaceLabels read_labels_txt(const std::filesystem::path& path, std::size_t face_count);
/// Writes one 0-based segment index per face and line. Segments are the connected components of equal label,
/// numbered in order of their first face. Faces are the source faces of `mesh`; two are connected if they share an
/// edge.
void write_seg(const std::filesystem::path& path, const TriangleMesh& mesh, const FaceLabels& labels);
/// Reads a .seg file: one non-negative integer per face.
std::vector<std::int32_t> read_seg(const std::filesystem::path& path, std::size_t face_count);

}  // namespace exemplar
