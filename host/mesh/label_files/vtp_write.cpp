// VTK's XML PolyData with inline base64 and lengths of 64 bits.
#include <fmt/format.h>

#include "host/core/text.h"
#include "host/mesh/io/io_write_text.h"
#include "host/mesh/label_files/label_formats.h"

namespace exemplar::label_files {
namespace {

/// An array element with its length before its bytes.
std::string data_array(std::string_view type, std::string_view name, int components, std::string_view bytes) {
    std::string with_length;
    with_length.reserve(bytes.size() + 8);
    mesh_io::append_bytes(with_length, static_cast<std::uint64_t>(bytes.size()));
    with_length += bytes;
    return fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}</DataArray>\n", type, name,
        components, base64(with_length));
}

/// The names as VTK stores strings: codes of characters, each string ends with 0.
std::string names_array(const std::vector<std::string>& names) {
    std::string codes;
    for (const std::string& name : names) {
        for (const char c : name) codes += fmt::format("{} ", static_cast<int>(static_cast<unsigned char>(c)));
        codes += "0 ";
    }
    return fmt::format("<Array type=\"String\" Name=\"LabelNames\" NumberOfTuples=\"{}\" format=\"ascii\">{}</Array>\n",
                       names.size(), codes);
}

std::string points_of(const TriangleMesh& mesh) {
    std::string bytes;
    const bool is_far = mesh.origin != Vec3d::Zero();
    for (const Vec3& p : mesh.vertices)
        for (int i = 0; i < 3; ++i)
            if (is_far)
                mesh_io::append_bytes(bytes, mesh.origin[i] + double{p[i]});
            else
                mesh_io::append_bytes(bytes, p[i]);
    return data_array(is_far ? "Float64" : "Float32", "Points", 3, bytes);
}

/// The corners of the source faces, and where each face ends.
std::string polygons_of(const MeshFile& file) {
    std::string corners, ends;
    std::int64_t end = 0;
    const auto end_face = [&](std::size_t count) {
        end += static_cast<std::int64_t>(count);
        mesh_io::append_bytes(ends, end);
    };
    if (file.polygons.corner_counts.empty()) {
        for (const Face& face : file.mesh.faces) {
            for (const std::uint32_t corner : face) mesh_io::append_bytes(corners, std::int64_t{corner});
            end_face(3);
        }
    } else {
        for (const std::uint32_t corner : file.polygons.corners) mesh_io::append_bytes(corners, std::int64_t{corner});
        for (const std::uint32_t count : file.polygons.corner_counts) end_face(count);
    }
    return data_array("Int64", "connectivity", 1, corners) + data_array("Int64", "offsets", 1, ends);
}

}  // namespace

std::string vtp_of_labels(const MeshFile& file, const FaceLabels& labels) {
    std::string label_bytes;
    for (const std::int32_t label : labels.label) mesh_io::append_bytes(label_bytes, label);
    return fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n{}</FieldData>\n<Piece NumberOfPoints=\"{}\" "
        "NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n<Points>\n{}</Points>\n"
        "<CellData Scalars=\"Label\">\n{}</CellData>\n<Polys>\n{}</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n",
        names_array(labels.names), file.mesh.vertex_count(), labels.label.size(), points_of(file.mesh),
        data_array("Int32", "Label", 1, label_bytes), polygons_of(file));
}

}  // namespace exemplar::label_files
