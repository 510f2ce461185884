#include <fmt/format.h>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar {
namespace {

std::string ply_header(const TriangleMesh& mesh, const FaceLabels* labels, bool with_confidence) {
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment made by Exemplar\n";
    if (labels)
        for (std::size_t i = 0; i < labels->names.size(); ++i)
            header += fmt::format("comment label {} {}\n", i, labels->names[i]);
    header +=
        fmt::format("element vertex {}\nproperty float x\nproperty float y\nproperty float z\n", mesh.vertex_count());
    header += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", mesh.face_count());
    if (labels) header += "property int label\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n";
    if (with_confidence) header += "property float confidence\n";
    return header + "end_header\n";
}

}  // namespace

void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, const FaceLabels* labels,
               std::span<const float> confidence) {
    if (labels) mesh_io::check_labels(mesh, *labels);
    if (!confidence.empty() && confidence.size() != mesh_io::source_faces(mesh))
        throw UsageError(fmt::format("{} confidences were given for a mesh of {} faces", confidence.size(),
                                     mesh_io::source_faces(mesh)));
    std::string bytes = ply_header(mesh, labels, !confidence.empty());
    for (const Vec3& p : mesh.vertices)
        for (int i = 0; i < 3; ++i) mesh_io::append_bytes(bytes, p[i]);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const std::uint32_t source = mesh.source_of(f);
        bytes += '\3';
        mesh_io::append_bytes(bytes, mesh.faces[f]);
        if (labels) {
            const std::int32_t label = labels->label[source];
            mesh_io::append_bytes(bytes, label);
            mesh_io::append_bytes(bytes, label < 0 ? k_unlabeled_color : label_color(static_cast<std::size_t>(label)));
        }
        if (!confidence.empty()) mesh_io::append_bytes(bytes, confidence[source]);
    }
    write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
}

}  // namespace exemplar
