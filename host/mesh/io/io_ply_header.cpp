#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "host/core/text.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_ply.h"
#include "host/mesh/io/io_text.h"

namespace exemplar::mesh_io {
namespace {

/// Returns the file up to and including the end_header line. Its line end is that of the first line.
std::string_view header_text(std::string_view content, const std::string& name) {
    if (!content.starts_with("ply\n") && !content.starts_with("ply\r"))
        fail(name + ":1", "a PLY file begins with a line that says ply");
    const char line_end = content[3] == '\n' || content.substr(4).starts_with('\n') ? '\n' : '\r';
    std::size_t end = 3;
    do {
        end = content.find("end_header", end + 1);
        if (end == std::string_view::npos) fail(name, "the header has no end_header line; the file is cut off");
    } while (content[end - 1] != '\n' && content[end - 1] != '\r');
    end = content.find(line_end, end);
    return content.substr(0, end == std::string_view::npos ? content.size() : end + 1);
}

PlyScalar read_type(TextCursor& cursor) {
    constexpr std::array<std::pair<std::string_view, PlyScalar>, 16> k_types{{{"char", PlyScalar::int8},
                                                                              {"int8", PlyScalar::int8},
                                                                              {"uchar", PlyScalar::uint8},
                                                                              {"uint8", PlyScalar::uint8},
                                                                              {"short", PlyScalar::int16},
                                                                              {"int16", PlyScalar::int16},
                                                                              {"ushort", PlyScalar::uint16},
                                                                              {"uint16", PlyScalar::uint16},
                                                                              {"int", PlyScalar::int32},
                                                                              {"int32", PlyScalar::int32},
                                                                              {"uint", PlyScalar::uint32},
                                                                              {"uint32", PlyScalar::uint32},
                                                                              {"float", PlyScalar::float32},
                                                                              {"float32", PlyScalar::float32},
                                                                              {"double", PlyScalar::float64},
                                                                              {"float64", PlyScalar::float64}}};
    const std::string_view word = cursor.word();
    for (const auto& [name, type] : k_types)
        if (word == name) return type;
    cursor.fail(fmt::format("a property type such as float or int is expected, not {}", quote(word)));
}

void read_format(TextCursor& cursor, PlyHeader& header) {
    const std::string_view word = cursor.word();
    if (word == "ascii")
        header.encoding = PlyEncoding::ascii;
    else if (word == "binary_little_endian")
        header.encoding = PlyEncoding::little_endian;
    else if (word == "binary_big_endian")
        header.encoding = PlyEncoding::big_endian;
    else
        cursor.fail(fmt::format("format {} is none of ascii, binary_little_endian, binary_big_endian", quote(word)));
}

void read_element(TextCursor& cursor, PlyHeader& header) {
    const std::string name(cursor.word());
    const std::int64_t count = cursor.integer("the number of elements");
    if (count < 0) cursor.fail(fmt::format("there cannot be {} of element {}", count, quote(name)));
    const auto same_name = [&](const PlyElement& element) { return element.name == name; };
    if (std::ranges::any_of(header.elements, same_name)) cursor.fail("element " + quote(name) + " is declared twice");
    header.elements.push_back({name, quote(name), static_cast<std::uint64_t>(count), {}});
}

void read_property(TextCursor& cursor, PlyHeader& header) {
    if (header.elements.empty()) cursor.fail("a property stands before the first element");
    PlyProperty property;
    TextCursor ahead = cursor;
    if (ahead.word() == "list") {
        cursor.word();
        property.count_type = read_type(cursor);
        if (!is_integer(*property.count_type)) cursor.fail("the item count of a list must have an integer type");
    }
    property.type = read_type(cursor);
    property.name = cursor.word();
    if (property.name.empty()) cursor.fail("the property has no name");
    property.shown = quote(property.name);
    header.elements.back().properties.push_back(std::move(property));
}

/// Stores `label INDEX NAME`; skips any other comment.
void read_comment(TextCursor& cursor, PlyHeader& header) {
    if (cursor.word() != "label") return;
    const auto index = parse_integer(cursor.word());
    const std::string_view name = trimmed(cursor.rest());
    if (!index || name.empty()) return;
    if (!is_utf8(name)) cursor.fail("label name " + quote(name) + " is not UTF-8; save the file in that encoding");
    if (!is_label_name(name)) cursor.fail("no label can have the name " + quote(name) + "; give it another");
    header.label_names[*index] = name;
}

}  // namespace

std::size_t byte_size(PlyScalar type) {
    constexpr std::array<std::size_t, 8> k_sizes{1, 1, 2, 2, 4, 4, 4, 8};
    return k_sizes[static_cast<std::size_t>(type)];
}

PlyHeader read_ply_header(std::string_view content, const std::string& name) {
    const std::string_view text = header_text(content, name);
    TextCursor cursor(text, name);
    PlyHeader header;
    bool has_format = false;
    cursor.next_line();  // ply
    while (cursor.next_line()) {
        const std::string_view keyword = cursor.word();
        if (keyword == "end_header") break;
        if (keyword == "format") {
            read_format(cursor, header);
            has_format = true;
        } else if (keyword == "element") {
            read_element(cursor, header);
        } else if (keyword == "property") {
            read_property(cursor, header);
        } else if (keyword == "comment") {
            read_comment(cursor, header);
        } else if (keyword != "obj_info") {
            cursor.fail(fmt::format("the header line begins with {}, which PLY does not know", quote(keyword)));
        }
    }
    if (!has_format) cursor.fail("the header has no format line");
    header.bytes = text.size();
    header.lines = cursor.line_number();
    return header;
}

}  // namespace exemplar::mesh_io
