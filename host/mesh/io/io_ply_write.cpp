#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar {
namespace {

/// The rows of the faces, with what is known about each.
struct PlyFaces {
    const FaceLabels* labels;
    std::span<const float> confidence;
    std::uint32_t most_corners;
    std::string bytes;

    const char* count_type() const { return most_corners <= 255 ? "uchar" : "uint"; }
    void append(std::span<const std::uint32_t> corners, std::uint32_t source) {
        const auto count = static_cast<std::uint32_t>(corners.size());
        if (most_corners <= 255)
            mesh_io::append_bytes(bytes, static_cast<std::uint8_t>(count));
        else
            mesh_io::append_bytes(bytes, count);
        for (const std::uint32_t corner : corners) mesh_io::append_bytes(bytes, corner);
        if (labels) {
            const std::int32_t label = labels->label[source];
            mesh_io::append_bytes(bytes, label);
            mesh_io::append_bytes(bytes, label < 0 ? k_unlabeled_color : label_color(static_cast<std::size_t>(label)));
        }
        if (!confidence.empty()) mesh_io::append_bytes(bytes, confidence[source]);
    }
};

std::string ply_header(const TriangleMesh& mesh, const PlyFaces& faces, std::size_t face_count) {
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment made by Exemplar\n";
    if (faces.labels)
        for (std::size_t i = 0; i < faces.labels->names.size(); ++i)
            header += fmt::format("comment label {} {}\n", i, faces.labels->names[i]);
    const char* const type = mesh.origin.isZero(0) ? "float" : "double";
    header +=
        fmt::format("element vertex {0}\nproperty {1} x\nproperty {1} y\nproperty {1} z\n", mesh.vertex_count(), type);
    header += fmt::format("element face {}\nproperty list {} int vertex_indices\n", face_count, faces.count_type());
    if (faces.labels) header += "property int label\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n";
    if (!faces.confidence.empty()) header += "property float confidence\n";
    return header + "end_header\n";
}

void check_polygons(const TriangleMesh& mesh, const Polygons& polygons) {
    const auto corners = std::accumulate(polygons.corner_counts.begin(), polygons.corner_counts.end(), std::size_t{0});
    if (polygons.corner_counts.size() != mesh_io::source_faces(mesh) || polygons.corners.size() != corners ||
        std::ranges::any_of(polygons.corners, [&](std::uint32_t v) { return v >= mesh.vertex_count(); }))
        throw UsageError("the polygons to write are not those of the mesh");
}

std::uint32_t largest_count(const Polygons& polygons) {
    return *std::ranges::max_element(polygons.corner_counts);
}

void append_polygons(PlyFaces& faces, const Polygons& polygons) {
    std::size_t begin = 0;
    for (std::uint32_t i = 0; i < polygons.corner_counts.size(); ++i) {
        faces.append(std::span(polygons.corners).subspan(begin, polygons.corner_counts[i]), i);
        begin += polygons.corner_counts[i];
    }
}

void append_vertices(std::string& bytes, const TriangleMesh& mesh) {
    const bool is_float = mesh.origin.isZero(0);
    for (const Vec3& p : mesh.vertices)
        for (int i = 0; i < 3; ++i) {
            if (is_float)
                mesh_io::append_bytes(bytes, p[i]);
            else
                mesh_io::append_bytes(bytes, mesh.origin[i] + double{p[i]});
        }
}

}  // namespace

void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, const FaceLabels* labels,
               std::span<const float> confidence, const Polygons* polygons) {
    if (labels) mesh_io::check_labels(mesh, *labels);
    if (!confidence.empty() && confidence.size() != mesh_io::source_faces(mesh))
        throw UsageError(fmt::format("{} confidences were given for a mesh of {} faces", confidence.size(),
                                     mesh_io::source_faces(mesh)));
    const bool has_polygons = polygons && !polygons->corner_counts.empty();
    if (has_polygons) check_polygons(mesh, *polygons);
    PlyFaces faces{labels, confidence, has_polygons ? largest_count(*polygons) : 3, {}};
    if (has_polygons)
        append_polygons(faces, *polygons);
    else
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f) faces.append(mesh.faces[f], mesh.source_of(f));
    std::string bytes = ply_header(mesh, faces, has_polygons ? polygons->corner_counts.size() : mesh.face_count());
    append_vertices(bytes, mesh);
    bytes += faces.bytes;
    write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
}

}  // namespace exemplar
