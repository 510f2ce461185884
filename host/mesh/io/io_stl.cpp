// Reads STL: unconnected triangles as text or binary; corners at the same position become one vertex.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "host/core/text.h"
#include "host/mesh/editing/weld.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_polygons.h"
#include "host/mesh/io/io_text.h"

namespace exemplar::mesh_io {
namespace {

constexpr std::size_t k_header_bytes = 80, k_count_end = 84, k_triangle_bytes = 50;

std::uint32_t triangle_count_field(std::string_view content) {
    std::array<unsigned char, 4> b;
    std::memcpy(b.data(), content.data() + k_header_bytes, b.size());
    return b[0] | std::uint32_t{b[1]} << 8 | std::uint32_t{b[2]} << 16 | std::uint32_t{b[3]} << 24;
}

/// Returns whether a file is binary. Binary files may begin with "solid" too, so first the size is compared with the
/// count field. If it differs, a zero byte shows that the file is not text.
bool is_binary(std::string_view content) {
    const bool has_count = content.size() >= k_count_end;
    if (has_count && content.size() == k_count_end + k_triangle_bytes * std::uint64_t{triangle_count_field(content)})
        return true;
    const std::string_view start = without_mark(content).substr(0, 512);
    return !lower_case(trimmed(start)).starts_with("solid") || start.find('\0') != std::string_view::npos;
}

/// Reads the triangles of text files, with lines like `vertex 1 0 0` in any case. Some programs write all of it on one
/// line.
class AsciiStl {
  public:
    AsciiStl(std::string_view content, const std::string& name) : cursor_(content, name) {}

    void read(PolygonList& polygons) {
        cursor_.need_line("solid");
        expect("solid");
        for (std::string keyword = next_keyword(); !keyword.empty(); keyword = next_keyword()) {
            if (keyword == "facet")
                read_facet(polygons);
            else if (keyword == "endsolid")
                ended_ = true;
            else if (keyword == "solid")
                ended_ = false;
            else
                cursor_.fail(fmt::format("facet or endsolid is expected, not {}", quote(keyword)));
        }
        if (!ended_) cursor_.fail("the file ends without endsolid; it is cut off");
    }

  private:
    void expect(std::string_view keyword) {
        const std::string_view word = cursor_.word();
        if (lower_case(word) != keyword) cursor_.fail(fmt::format("{} is expected, not {}", keyword, quote(word)));
    }
    /// Returns the next facet or endsolid on this line, else the first word of the next line; empty at the end of the
    /// file. Names of solids are skipped. They may contain such words, so `facet` counts only before `normal`, and
    /// `endsolid` only if a facet has ended on this line.
    std::string next_keyword() {
        while (!cursor_.rest().empty()) {
            std::string word = lower_case(cursor_.word());
            std::string_view rest = cursor_.rest();
            if (word == "facet" && lower_case(take_word(rest)) == "normal") return word;
            if (word == "endsolid" && facet_line_ == cursor_.line_number()) return word;
        }
        return cursor_.next_line() ? lower_case(cursor_.word()) : std::string();
    }
    /// Goes to a keyword: the next one on this line, else the first word of the next line.
    void go_to(std::string_view keyword, std::string_view expected) {
        constexpr std::array<std::string_view, 8> k_keywords{"solid",  "facet",   "outer",    "loop",
                                                             "vertex", "endloop", "endfacet", "endsolid"};
        while (!cursor_.rest().empty()) {
            std::string_view rest = cursor_.rest();
            if (std::ranges::find(k_keywords, lower_case(take_word(rest))) != k_keywords.end()) return expect(keyword);
            cursor_.word();
        }
        cursor_.need_line(expected);
        expect(keyword);
    }
    void read_facet(PolygonList& polygons) {
        go_to("outer", "outer loop");
        expect("loop");
        std::array<std::uint32_t, 3> corners;
        for (std::uint32_t& corner : corners) {
            go_to("vertex", "a vertex");
            const float x = coordinate("the x of a vertex"), y = coordinate("the y of a vertex");
            corner = welder_.add({x, y, coordinate("the z of a vertex")}, polygons.vertices);
        }
        go_to("endloop", "endloop");
        go_to("endfacet", "endfacet");
        facet_line_ = cursor_.line_number();
        ended_ = false;
        polygons.add(corners);
    }
    float coordinate(std::string_view what) { return static_cast<float>(cursor_.number(what)); }

    TextCursor cursor_;
    VertexWelder welder_;
    bool ended_ = false;
    std::size_t facet_line_ = 0;  ///< the line on which the last facet ended
};

float little_endian_float(const char* bytes) {
    float value;
    std::memcpy(&value, bytes, sizeof(value));
    return value;
}

/// Throws if the file is text.
void refuse_other_text(std::string_view content, const std::string& name) {
    refuse_utf16(content, name);
    const std::string_view start = content.substr(0, 512);
    const auto is_control = [](char c) { return c >= 0 && c < ' ' && !is_space(c); };
    if (std::ranges::any_of(start, is_control)) return;
    std::string_view line = trimmed(start);
    fail(name + ":1",
         fmt::format("an STL file in text begins with the word solid, not with {}", quote(take_word(line))));
}

void read_binary(std::string_view content, const std::string& name, PolygonList& polygons,
                 std::vector<std::string>& warnings) {
    if (content.size() < k_count_end)
        fail(name, fmt::format("byte {}: an STL file begins with the word solid or has at least {} bytes",
                               content.size(), k_count_end));
    const std::uint64_t count = triangle_count_field(content), end = k_count_end + k_triangle_bytes * count;
    if (end > content.size()) refuse_other_text(content, name);
    if (end > content.size())
        fail(name, fmt::format("byte {}: {} triangles need {} bytes, but the file has {}; it is cut off or no STL file",
                               k_header_bytes, count, end, content.size()));
    if (count == 0 && end < content.size())
        fail(name, fmt::format("byte {}: a count of 0 triangles in a file of {} bytes; it is damaged or no STL file",
                               k_header_bytes, content.size()));
    if (end < content.size())
        warnings.push_back(fmt::format("{} bytes after the last triangle were left out", content.size() - end));
    VertexWelder welder;
    polygons.reserve_polygons(count);
    for (std::uint64_t t = 0; t < count; ++t) {
        const char* const triangle = content.data() + k_count_end + k_triangle_bytes * t + 12;  // after the normal
        std::array<std::uint32_t, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            const char* const p = triangle + 12 * i;
            corners[i] = welder.add({little_endian_float(p), little_endian_float(p + 4), little_endian_float(p + 8)},
                                    polygons.vertices);
        }
        polygons.add(corners);
    }
}

}  // namespace

MeshFile read_stl(std::string_view content, const std::string& name) {
    MeshFile file;
    PolygonList polygons;
    if (is_binary(content))
        read_binary(content, name, polygons, file.warnings);
    else
        AsciiStl(content, name).read(polygons);
    std::move(polygons).triangulate_into(file);
    return file;
}

}  // namespace exemplar::mesh_io
