// The benchmark's label files (_labels.txt) and segment files (.seg).
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "host/core/disjoint_sets.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/text.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/io/io_write_text.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace mesh_io {

std::size_t source_faces(const TriangleMesh& mesh) {
    const bool only_triangles = mesh.source_face.empty() && !mesh.faces.empty();
    return only_triangles ? mesh.face_count() : mesh.source_face_count;
}

namespace {

constexpr std::string_view k_byte_order_mark = "\xef\xbb\xbf";

/// Returns whether a line lists face indices, that is, begins with two numbers; such a line is no name.
bool is_index_line(std::string_view line) {
    return parse_integer(take_word(line)) && parse_integer(take_word(line));
}

}  // namespace

bool is_label_name(std::string_view name) {
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
    return !name.empty() && std::ranges::none_of(name, is_control) && trimmed(name).size() == name.size() &&
           is_utf8(name) && !name.starts_with(k_byte_order_mark) && !is_index_line(name);
}

void check_label_names(const FaceLabels& labels) {
    for (std::size_t i = 0; i < labels.names.size(); ++i) {
        const std::string& name = labels.names[i];
        if (!is_label_name(name))
            throw DataError(
                fmt::format("label {} has the name {}, which a file cannot hold; give it a name in one line of UTF-8, "
                            "without spaces around it and not of numbers",
                            i, quote(name)));
    }
}

void check_labels(const TriangleMesh& mesh, const FaceLabels& labels) {
    if (labels.label.size() != source_faces(mesh))
        throw UsageError(
            fmt::format("{} labels were given for a mesh of {} faces", labels.label.size(), source_faces(mesh)));
    const auto name_count = static_cast<std::int64_t>(labels.names.size());
    for (std::size_t f = 0; f < labels.label.size(); ++f)
        if (labels.label[f] < -1 || labels.label[f] >= name_count)
            throw UsageError(
                fmt::format("face {} has label {}, but there are {} names", f, labels.label[f], name_count));
    check_label_names(labels);
}

}  // namespace mesh_io

namespace {

/// The lines of a file in memory, blank ones included; errors are DataError "PATH:LINE: MESSAGE".
class DataLines {
  public:
    explicit DataLines(const std::filesystem::path& path) : name_(path.string()), content_(read_file(path)) {
        if (content_.starts_with(mesh_io::k_byte_order_mark)) at_ = mesh_io::k_byte_order_mark.size();
    }
    bool next() {
        if (at_ >= content_.size()) return false;
        const std::size_t end = std::min(content_.find('\n', at_), content_.size());
        line_ = mesh_io::trimmed(std::string_view(content_).substr(at_, end - at_));
        at_ = end + 1;
        ++line_number_;
        return true;
    }
    std::string_view line() const { return line_; }
    [[noreturn]] void fail(const std::string& message) const {
        throw DataError(fmt::format("{}:{}: {}", name_, line_number_, message));
    }

  private:
    std::string name_, content_;
    std::string_view line_;
    std::size_t at_ = 0, line_number_ = 0;
};

/// Throws unless the line is a valid name. Names end up in model and JSON files, which hold UTF-8 only. Two numbers
/// or more instead of a name are the face indices of a block whose name is missing.
void check_name_line(const DataLines& lines) {
    const std::string_view name = lines.line();
    if (!is_utf8(name))
        lines.fail(fmt::format("label name {} is not UTF-8; save the file in that encoding", mesh_io::quote(name)));
    if (mesh_io::is_index_line(name))
        lines.fail("a label name is expected, not face indices; each label has one line of indices");
    if (!mesh_io::is_label_name(name))
        lines.fail(fmt::format("label name {} has control characters or a byte order mark; is this a label file?",
                               mesh_io::quote(name)));
}

/// Labels the faces that the current line lists.
void read_face_indices(const DataLines& lines, std::int32_t label, FaceLabels& labels) {
    std::string_view rest = lines.line();
    for (std::string_view word = mesh_io::take_word(rest); !word.empty(); word = mesh_io::take_word(rest)) {
        const auto index = mesh_io::parse_integer(word);
        const auto name = [&](std::int32_t of) { return mesh_io::quote(labels.names[static_cast<std::size_t>(of)]); };
        if (!index)
            lines.fail(fmt::format("a face index of label {} is expected, not {}", name(label), mesh_io::quote(word)));
        if (*index < 1 || *index > static_cast<std::int64_t>(labels.label.size()))
            lines.fail(fmt::format("label {} names face {}, but the mesh has {} faces, counted from 1", name(label),
                                   *index, labels.label.size()));
        std::int32_t& face = labels.label[static_cast<std::size_t>(*index - 1)];
        if (face >= 0) lines.fail(fmt::format("face {} has two labels, {} and {}", *index, name(face), name(label)));
        face = label;
    }
}

}  // namespace

void write_labels_txt(const std::filesystem::path& path, const FaceLabels& labels) {
    mesh_io::check_label_names(labels);
    std::vector<std::string> lines(labels.names.size());
    for (std::size_t f = 0; f < labels.label.size(); ++f) {
        if (labels.label[f] < 0 || static_cast<std::size_t>(labels.label[f]) >= lines.size())
            throw DataError(fmt::format("{}: face {} has no label, which this form cannot say", path.string(), f + 1));
        std::string& line = lines[static_cast<std::size_t>(labels.label[f])];
        if (!line.empty()) line += ' ';
        mesh_io::append_number(line, f + 1);
    }
    write_file_atomically(path, [&](std::ostream& out) {
        for (std::size_t i = 0; i < lines.size(); ++i)
            if (!lines[i].empty()) out << labels.names[i] << '\n' << lines[i] << '\n';
    });
}

FaceLabels read_labels_txt(const std::filesystem::path& path, std::size_t face_count) {
    DataLines lines(path);
    FaceLabels labels;
    labels.label.assign(face_count, -1);
    std::map<std::string, std::int32_t, std::less<>> number;
    while (lines.next()) {
        if (lines.line().empty()) continue;
        check_name_line(lines);
        const auto [entry, is_new] =
            number.try_emplace(std::string(lines.line()), static_cast<std::int32_t>(labels.names.size()));
        if (is_new) labels.names.push_back(entry->first);
        if (lines.next()) read_face_indices(lines, entry->second, labels);
    }
    const auto unlabeled = std::ranges::find(labels.label, -1);
    if (unlabeled != labels.label.end())
        lines.fail(fmt::format("the file ends, but {} of {} faces have no label; the first is face {}",
                               std::ranges::count(labels.label, -1), face_count, unlabeled - labels.label.begin() + 1));
    return labels;
}

void write_seg(const std::filesystem::path& path, const TriangleMesh& mesh, const FaceLabels& labels) {
    mesh_io::check_labels(mesh, labels);
    DisjointSets sets(labels.label.size());
    for (const Edge& edge : build_topology(mesh).edges) {
        if (edge.is_boundary()) continue;
        const std::uint32_t a = mesh.source_of(edge.face[0]), b = mesh.source_of(edge.face[1]);
        if (labels.label[a] == labels.label[b]) sets.join(a, b);
    }
    std::string text;
    std::vector<std::uint32_t> number(labels.label.size());
    std::uint32_t count = 0;
    for (std::uint32_t f = 0; f < number.size(); ++f) {
        const std::uint32_t first = sets.find(f);
        number[f] = first == f ? count++ : number[first];
        mesh_io::append_number(text, number[f]);
        text += '\n';
    }
    write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

std::vector<std::int32_t> read_seg(const std::filesystem::path& path, std::size_t face_count) {
    DataLines lines(path);
    std::vector<std::int32_t> segments;
    while (lines.next()) {
        if (lines.line().empty()) continue;
        const auto value = mesh_io::parse_integer(lines.line());
        if (!value || *value < 0 || *value > std::numeric_limits<std::int32_t>::max())
            lines.fail(fmt::format("a segment number is expected, not {}", mesh_io::quote(lines.line())));
        if (segments.size() == face_count) lines.fail(fmt::format("the mesh has only {} faces", face_count));
        segments.push_back(static_cast<std::int32_t>(*value));
    }
    if (segments.size() != face_count)
        lines.fail(
            fmt::format("the file has {} segment numbers, but the mesh has {} faces", segments.size(), face_count));
    return segments;
}

}  // namespace exemplar
