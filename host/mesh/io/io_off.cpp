// Reads OFF, the Object File Format of Geomview: a header word, the counts, the vertices, the faces.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

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

/// How vertices and faces lie on the lines of a file. Most files have one on each line, whose end then tells where
/// colors end and a number is missing. But the format lets any white space separate numbers.
enum class Layout {
    one_per_line,
    over_lines,  ///< each begins on a new line and may continue on the next: there are more lines than elements
    shared       ///< a line may hold several: there are fewer lines than elements
};

class OffReader {
  public:
    OffReader(std::string_view content, const std::string& name) : cursor_(content, name, '#') {}

    MeshFile read() {
        cursor_.need_line("the word OFF");
        check_header();
        read_counts();
        MeshFile file;
        PolygonList polygons;
        read_vertices(polygons.positions);
        read_faces(polygons);
        check_end(file.warnings);
        std::move(polygons).triangulate_into(file);
        return file;
    }

  private:
    /// Header words are [ST][C][N][4][n]OFF. Texture, color and normal follow the position of a vertex and are
    /// skipped; 4 and n change the number of coordinates and are not supported. In some files of large collections the
    /// counts follow without a space, as in OFF490 518 0.
    void check_header() {
        std::string_view word = cursor_.word();
        const std::size_t end = word.find("OFF") + 3;
        if (word.find("OFF") != std::string_view::npos && end < word.size() && is_digit(word[end])) {
            cursor_.put_back(word.substr(end));
            word = word.substr(0, end);
        }
        std::string_view prefix = word;
        if (!word.ends_with("OFF"))
            cursor_.fail(fmt::format("an OFF file begins with the word OFF, not with {}", quote(word)));
        prefix.remove_suffix(3);
        constexpr std::array<std::pair<std::string_view, int>, 3> k_parts{{{"ST", 2}, {"C", 4}, {"N", 3}}};
        for (const auto& [part, numbers] : k_parts)
            if (prefix.starts_with(part)) {
                prefix.remove_prefix(part.size());
                extra_numbers_ += numbers;
            }
        if (!prefix.empty())
            cursor_.fail(
                fmt::format("header {} is not supported; export plain OFF with three coordinates", quote(word)));
    }

    /// Reads the numbers of vertices, faces and edges. Each vertex and face takes some bytes, so both are checked
    /// against the size of the file before memory is reserved.
    void read_counts() {
        if (trimmed(cursor_.rest()).empty()) cursor_.need_line("the line of vertex and face counts");
        if (lower_case(trimmed(cursor_.rest())).starts_with("binary"))
            cursor_.fail("binary OFF is not supported; export it as text or as PLY");
        const std::int64_t vertices = cursor_.integer("the number of vertices");
        need_number("the number of faces");
        const std::int64_t faces = cursor_.integer("the number of faces");
        const auto left = static_cast<std::int64_t>(cursor_.rest().size() + cursor_.bytes_left());
        constexpr std::int64_t k_vertex_bytes = 5, k_face_bytes = 2;  // "0 0 0", "0" and a line end
        if (vertices < 0 || faces < 0 || vertices > left / k_vertex_bytes || faces > left / k_face_bytes + 1)
            cursor_.fail(
                fmt::format("{} vertices and {} faces cannot be in the {} bytes that follow; the counts are wrong or "
                            "the file is cut off",
                            vertices, faces, left));
        vertex_count_ = static_cast<std::size_t>(vertices);
        face_count_ = static_cast<std::size_t>(faces);
        skip_edge_count();
        layout_ = layout();
        if (layout_ == Layout::shared && !trimmed(cursor_.rest()).empty()) cursor_.integer("the number of edges");
    }
    /// Skips the number of edges where it has a line of its own.
    void skip_edge_count() {
        if (!trimmed(cursor_.rest()).empty() || vertex_count_ == 0) return;
        TextCursor next = cursor_;
        if (next.next_line() && parse_integer(next.word()) && trimmed(next.rest()).empty()) cursor_ = next;
    }
    Layout layout() const {
        const std::size_t elements = vertex_count_ + face_count_;
        std::size_t lines = 0;
        for (TextCursor ahead = cursor_; lines <= elements && ahead.next_line();) ++lines;
        if (lines == elements) return Layout::one_per_line;
        return lines > elements ? Layout::over_lines : Layout::shared;
    }

    void begin(std::string_view element) {
        if (layout_ == Layout::shared)
            need_number(element);
        else
            cursor_.need_line(element);
    }
    void need_number(std::string_view what) {
        if (trimmed(cursor_.rest()).empty()) cursor_.need_line(what);
    }
    /// Throws if an element that began on line `first` ends in the middle of another: a number was missing, and that of
    /// the next element was taken.
    void check_line_end(std::size_t first, std::string_view element) {
        if (layout_ == Layout::over_lines && cursor_.line_number() != first && !trimmed(cursor_.rest()).empty())
            cursor_.fail(fmt::format("{} from line {} on ends in the middle of this line; a number is missing there",
                                     element, first));
    }
    /// Moves to the next line if this one has no number left and the layout allows that.
    void need_more(std::string_view what) {
        if (layout_ != Layout::one_per_line) need_number(what);
    }
    double number(std::string_view what) {
        need_more(what);
        return cursor_.number(what);
    }
    std::int64_t integer(std::string_view what) {
        need_more(what);
        return cursor_.integer(what);
    }

    void read_vertices(std::vector<Vec3d>& vertices) {
        vertices.reserve(vertex_count_);
        for (std::size_t v = 0; v < vertex_count_; ++v) {
            begin("a vertex");
            const std::size_t line = cursor_.line_number();
            const double x = number("the x of a vertex"), y = number("the y of a vertex");
            vertices.push_back({x, y, number("the z of a vertex")});
            for (int i = 0; i < extra_numbers_ && layout_ == Layout::shared; ++i) number("a color or normal");
            check_line_end(line, "a vertex");
        }
    }

    void read_faces(PolygonList& polygons) {
        polygons.reserve_polygons(face_count_);
        for (std::size_t f = 0; f < face_count_; ++f) {
            begin("a face");
            const std::size_t line = cursor_.line_number();
            read_face(f, polygons);
            check_line_end(line, "a face");
        }
    }
    void read_face(std::size_t f, PolygonList& polygons) {
        const std::int64_t corner_count = integer("the corner count of a face");
        const bool on_line = layout_ == Layout::one_per_line;
        const std::size_t bytes = cursor_.rest().size() + (on_line ? 0 : cursor_.bytes_left());
        if (corner_count < 0 || corner_count > static_cast<std::int64_t>(bytes) / 2)
            cursor_.fail(fmt::format("face {} cannot have {} corners {}", f, corner_count,
                                     on_line ? "on this line" : "in what is left of the file"));
        const auto vertex_count = static_cast<std::int64_t>(vertex_count_);
        corners_.clear();
        for (std::int64_t i = 0; i < corner_count; ++i) {
            const std::int64_t corner = integer("a corner of a face");
            if (corner < 0 || corner >= vertex_count)
                cursor_.fail(fmt::format("face {} names vertex {}, but the file has {} vertices, counted from 0", f,
                                         corner, vertex_count));
            corners_.push_back(static_cast<std::uint32_t>(corner));
        }
        polygons.add(corners_);  // colors may follow on its line and are skipped
    }

    /// Warns of what follows the last face. In a shared layout it is an error: numbers were taken for others.
    void check_end(std::vector<std::string>& warnings) {
        const bool shared = layout_ == Layout::shared, more_on_line = !trimmed(cursor_.rest()).empty();
        if (!(shared && more_on_line) && !cursor_.next_line()) return;
        if (shared)
            cursor_.fail("more numbers follow than vertices and faces need; the counts are wrong or lines are missing");
        warnings.push_back(
            fmt::format("what follows the last face, from line {} on, was left out", cursor_.line_number()));
    }

    TextCursor cursor_;
    std::size_t vertex_count_ = 0, face_count_ = 0;
    int extra_numbers_ = 0;  ///< per vertex, after its position
    Layout layout_ = Layout::one_per_line;
    std::vector<std::uint32_t> corners_;  ///< of the current face
};

}  // namespace

MeshFile read_off(std::string_view content, const std::string& name) {
    return OffReader(content, name).read();
}

}  // namespace mesh_io

void write_off(const std::filesystem::path& path, const TriangleMesh& mesh) {
    std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertex_count(), mesh.face_count());
    for (const Vec3& p : mesh.vertices) {
        for (int i = 0; i < 3; ++i) {
            mesh_io::append_coordinate(text, mesh, p, i);
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
