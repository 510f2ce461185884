// Reads OBJ through tinyobjloader. The library accepts almost anything without complaint (a word that is no number
// becomes 0). So each line is checked here before it is passed on, and the current line number is known in the
// library's callbacks.
#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <istream>
#include <limits>
#include <span>
#include <streambuf>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_polygons.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar {
namespace mesh_io {
namespace {

/// The data that the library's callbacks fill.
struct ObjContent {
    PolygonList polygons;
    std::vector<std::size_t> face_line;  ///< per polygon
    std::vector<std::uint32_t> corners;  ///< of the current face
    std::array<double, 3> position;      ///< of the current vertex, as checked
    std::size_t line = 0;
    std::string name;

    void add(std::span<const std::uint32_t> face) {
        polygons.add(face);
        face_line.push_back(line);
    }
    [[noreturn]] void fail(std::size_t at_line, const std::string& message) const {
        mesh_io::fail(fmt::format("{}:{}", name, at_line), message);
    }
};

/// Checks vertex and face lines and passes them to the library one by one; skips all other lines.
class CheckedLines : public std::streambuf {
  public:
    CheckedLines(std::string_view content, ObjContent& obj) : cursor_(content, obj.name, '#'), obj_(obj) {}
    /// The error that ended the input; streams swallow exceptions.
    const std::string& error() const { return error_; }

  protected:
    int_type underflow() override {
        try {
            if (!next()) return traits_type::eof();
        } catch (const MeshError& error) {
            error_ = error.what();
            return traits_type::eof();
        }
        setg(line_.data(), line_.data(), line_.data() + line_.size());
        return traits_type::to_int_type(line_.front());
    }

  private:
    bool next() {
        while (cursor_.next_line()) {
            std::string_view line = cursor_.rest();
            const std::string_view keyword = take_word(line);
            obj_.line = cursor_.line_number();
            if (keyword != "v" && keyword != "f") continue;
            line_.assign(cursor_.rest());
            join_continued_lines();
            if (keyword == "v") {
                check_vertex(std::string_view(line_).substr(1));
                line_ = "v 0 0 0";  // its numbers are known; the library's own parser overflows on long exponents
            } else {
                check_face(std::string_view(line_).substr(1));
                if (trimmed(line_) == "f") {  // the library would not count it
                    obj_.add({});
                    continue;
                }
                std::ranges::replace_if(line_, is_space, ' ');  // the library knows fewer kinds of space
            }
            line_ += '\n';
            return true;
        }
        return false;
    }
    /// A backslash at the end of a line continues it on the next.
    void join_continued_lines() {
        while (line_.ends_with('\\')) {
            line_.back() = ' ';
            if (!cursor_.next_line()) return;
            line_ += cursor_.rest();
        }
    }
    void check_vertex(std::string_view line) {
        for (double& coordinate : obj_.position) {
            const std::string_view word = take_word(line);
            if (word.empty()) obj_.fail(obj_.line, "a vertex needs three coordinates");
            const auto value = parse_number(word);
            if (!value) obj_.fail(obj_.line, fmt::format("a coordinate should be a number, not {}", quote(word)));
            coordinate = *value;
        }
    }
    void check_face(std::string_view line) const {
        for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
            std::string_view left = word;
            for (int part = 0; part < 3 && !left.empty(); ++part) {
                const std::size_t slash = left.find('/');
                const std::string_view index = left.substr(0, slash);
                if (!(index.empty() && part > 0) && !is_index(index))
                    obj_.fail(obj_.line,
                              fmt::format("a corner of a face should be like 3, 3/1 or 3//1, not {}", quote(word)));
                left = slash == std::string_view::npos ? std::string_view() : left.substr(slash + 1);
            }
            if (!left.empty())
                obj_.fail(obj_.line, fmt::format("a corner has at most three indices, unlike {}", quote(word)));
        }
    }
    static bool is_index(std::string_view word) {
        constexpr std::int64_t k_most = std::numeric_limits<int>::max();
        const auto value = parse_integer(word);
        return value && *value != 0 && *value >= -k_most && *value <= k_most;
    }

    TextCursor cursor_;
    ObjContent& obj_;
    std::string line_, error_;
};

/// The library reads nan as 0 and does not round exactly, so the checked numbers are used.
void on_vertex(void* user_data, tinyobj::real_t, tinyobj::real_t, tinyobj::real_t, tinyobj::real_t) {
    ObjContent& obj = *static_cast<ObjContent*>(user_data);
    obj.polygons.positions.push_back({obj.position[0], obj.position[1], obj.position[2]});
}

/// Indices count from 1, or back from the latest vertex if negative; positive ones may name vertices yet to come.
void on_face(void* user_data, tinyobj::index_t* indices, int count) {
    ObjContent& obj = *static_cast<ObjContent*>(user_data);
    const auto vertex_count = static_cast<std::int64_t>(obj.polygons.positions.size());
    obj.corners.clear();
    for (int i = 0; i < count; ++i) {
        const std::int64_t index = indices[i].vertex_index;
        const std::int64_t corner = index > 0 ? index - 1 : vertex_count + index;
        if (corner < 0)
            obj.fail(obj.line, fmt::format("a face names vertex {}, but only {} come before it", index, vertex_count));
        obj.corners.push_back(static_cast<std::uint32_t>(corner));
    }
    obj.add(obj.corners);
}

void check_corners(const ObjContent& obj) {
    std::size_t begin = 0;
    for (std::size_t f = 0; f < obj.polygons.size(); ++f) {
        for (std::uint32_t corner : obj.polygons.corners().subspan(begin, obj.polygons.corner_counts()[f]))
            if (corner >= obj.polygons.positions.size())
                obj.fail(obj.face_line[f], fmt::format("the face names vertex {}, but the file has {} vertices",
                                                       corner + 1, obj.polygons.positions.size()));
        begin += obj.polygons.corner_counts()[f];
    }
}

}  // namespace

MeshFile read_obj(std::string_view content, const std::string& name) {
    ObjContent obj;
    obj.name = name;
    CheckedLines lines(content, obj);
    std::istream stream(&lines);
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = on_vertex;
    callbacks.index_cb = on_face;
    std::string warning, error;
    const bool read = tinyobj::LoadObjWithCallback(stream, callbacks, &obj, nullptr, &warning, &error);
    if (!lines.error().empty()) throw MeshError(lines.error());
    if (!read || !error.empty()) obj.fail(obj.line, std::string(trimmed(error)));
    if (obj.polygons.positions.empty()) mesh_io::fail(name, "no line of this file is an OBJ vertex (v x y z)");
    check_corners(obj);
    MeshFile file;
    std::move(obj.polygons).triangulate_into(file);
    return file;
}

}  // namespace mesh_io

void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh) {
    std::string text;
    for (const Vec3& p : mesh.vertices) {
        text += 'v';
        for (int i = 0; i < 3; ++i) {
            text += ' ';
            mesh_io::append_coordinate(text, mesh, p, i);
        }
        text += '\n';
    }
    for (const Face& face : mesh.faces) {
        text += 'f';
        for (std::uint32_t corner : face) {
            text += ' ';
            mesh_io::append_number(text, corner + 1);
        }
        text += '\n';
    }
    write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

}  // namespace exemplar
