// Reads OFF, the Object File Format of Geomview: a header word, the counts, a line per vertex, a line per face.
#include <fmt/format.h>

#include <algorithm>

#include "host/core/files.h"
#include "host/core/text.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_polygons.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar {
namespace mesh_io {
namespace {

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Header words are [ST][C][N][4][n]OFF. Texture, color and normal follow the position on a vertex line and are
/// skipped; 4 and n change the number of coordinates and are not supported. In some files of large collections the
/// counts follow without a space, as in OFF490 518 0.
void check_header(TextCursor& cursor) {
    std::string_view word = cursor.word();
    const std::size_t end = word.find("OFF") + 3;
    if (word.find("OFF") != std::string_view::npos && end < word.size() && is_digit(word[end])) {
        cursor.put_back(word.substr(end));
        word = word.substr(0, end);
    }
    std::string_view prefix = word;
    if (!word.ends_with("OFF"))
        cursor.fail(fmt::format("an OFF file begins with the word OFF, not with {}", quote(word)));
    prefix.remove_suffix(3);
    for (std::string_view part : {"ST", "C", "N"})
        if (prefix.starts_with(part)) prefix.remove_prefix(part.size());
    if (!prefix.empty())
        cursor.fail(fmt::format("header {} is not supported; export plain OFF with three coordinates", quote(word)));
}

struct Counts {
    std::size_t vertices, faces;
};

/// Reads the vertex and face count, on the header's line or the next. Each vertex and face takes a line, so both are
/// checked against the size of the file before memory is reserved.
Counts read_counts(TextCursor& cursor) {
    if (trimmed(cursor.rest()).empty()) cursor.need_line("the line of vertex and face counts");
    if (lower_case(trimmed(cursor.rest())).starts_with("binary"))
        cursor.fail("binary OFF is not supported; export it as text or as PLY");
    const std::int64_t vertices = cursor.integer("the number of vertices"),
                       faces = cursor.integer("the number of faces");
    const auto left = static_cast<std::int64_t>(cursor.bytes_left());
    constexpr std::int64_t k_vertex_bytes = 5, k_face_bytes = 2;  // "0 0 0", "0" and a line end
    if (vertices < 0 || faces < 0 || vertices > left / k_vertex_bytes || faces > left / k_face_bytes + 1)
        cursor.fail(
            fmt::format("{} vertices and {} faces cannot be in the {} bytes that follow; the counts are wrong or "
                        "the file is cut off",
                        vertices, faces, left));
    return {static_cast<std::size_t>(vertices), static_cast<std::size_t>(faces)};
}

void read_vertices(TextCursor& cursor, std::size_t count, std::vector<Vec3>& vertices) {
    vertices.reserve(count);
    for (std::size_t v = 0; v < count; ++v) {
        cursor.need_line("a vertex");
        const float x = cursor.number("the x of a vertex"), y = cursor.number("the y of a vertex");
        vertices.push_back({x, y, cursor.number("the z of a vertex")});
    }
}

void read_faces(TextCursor& cursor, std::size_t count, PolygonList& polygons) {
    std::vector<std::uint32_t> corners;
    polygons.reserve_polygons(count);
    const auto vertex_count = static_cast<std::int64_t>(polygons.vertices.size());
    for (std::size_t f = 0; f < count; ++f) {
        cursor.need_line("a face");
        const std::int64_t corner_count = cursor.integer("the corner count of a face");
        if (corner_count < 0 || corner_count > static_cast<std::int64_t>(cursor.rest().size()) / 2)
            cursor.fail(fmt::format("face {} cannot have {} corners on this line", f, corner_count));
        corners.clear();
        for (std::int64_t i = 0; i < corner_count; ++i) {
            const std::int64_t corner = cursor.integer("a corner of a face");
            if (corner < 0 || corner >= vertex_count)
                cursor.fail(fmt::format("face {} names vertex {}, but the file has {} vertices, counted from 0", f,
                                        corner, vertex_count));
            corners.push_back(static_cast<std::uint32_t>(corner));
        }
        polygons.add(corners);  // colors may follow and are skipped
    }
}

}  // namespace

MeshFile read_off(std::string_view content, const std::string& name) {
    TextCursor cursor(content, name, '#');
    cursor.need_line("the word OFF");
    check_header(cursor);
    const Counts counts = read_counts(cursor);
    MeshFile file;
    PolygonList polygons;
    read_vertices(cursor, counts.vertices, polygons.vertices);
    read_faces(cursor, counts.faces, polygons);
    if (cursor.next_line())
        file.warnings.push_back(
            fmt::format("what follows the last face, from line {} on, was left out", cursor.line_number()));
    file.mesh = std::move(polygons).triangulate(file.warnings);
    return file;
}

}  // namespace mesh_io

void write_off(const std::filesystem::path& path, const TriangleMesh& mesh) {
    std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertex_count(), mesh.face_count());
    for (const Vec3& p : mesh.vertices) {
        for (int i = 0; i < 3; ++i) {
            mesh_io::append_number(text, p[i]);
            text += i < 2 ? ' ' : '\n';
        }
    }
    for (const Face& face : mesh.faces) {
        text += '3';
        for (std::uint32_t corner : face) {
            text += ' ';
            mesh_io::append_number(text, corner);
        }
        text += '\n';
    }
    write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

}  // namespace exemplar
