// Text with one label per line.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "host/core/text.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/label_files/label_formats.h"

namespace exemplar::label_files {
namespace {

/// Calls visit(line, number) for each line that is not blank, counted from 1.
template <typename Visit>
void for_each_line(std::string_view content, const Visit& visit) {
    content = mesh_io::without_mark(content);
    for (std::size_t at = 0, number = 1; at < content.size(); ++number) {
        const std::size_t end = std::min(content.find('\n', at), content.size());
        const std::string_view line = mesh_io::trimmed(content.substr(at, end - at));
        if (!line.empty()) visit(line, number);
        at = end + 1;
    }
}

[[noreturn]] void fail_line(const std::string& name, std::size_t line, const std::string& message) {
    fail(fmt::format("{}:{}", name, line), message);
}

/// Gives each face the name in its line.
FaceLabels labels_of_names(std::string_view content, const TriangleMesh& mesh, const std::string& name) {
    FaceLabels labels;
    std::map<std::string, std::int32_t, std::less<>> index;
    const std::size_t faces = mesh_io::source_faces(mesh);
    for_each_line(content, [&](std::string_view line, std::size_t number) {
        if (!mesh_io::is_label_name(line))
            fail_line(name, number, fmt::format("{} is neither a segment number nor a name", mesh_io::quote(line)));
        if (labels.label.size() == faces) fail_line(name, number, fmt::format("the mesh has only {} faces", faces));
        const auto [it, is_new] = index.try_emplace(std::string(line), static_cast<std::int32_t>(labels.names.size()));
        if (is_new) labels.names.emplace_back(line);
        labels.label.push_back(it->second);
    });
    if (labels.label.size() != faces)
        fail(name, fmt::format("has {} lines, but the mesh has {} faces", labels.label.size(), faces));
    return labels;
}

}  // namespace

bool is_number_list(std::string_view content) {
    bool all = true, any = false;
    for_each_line(content, [&](std::string_view line, std::size_t) {
        any = true;
        all = all && mesh_io::parse_integer(line).has_value();
    });
    return all && any;
}

FaceLabels read_number_list(std::string_view content, const TriangleMesh& mesh, const std::string& name) {
    std::vector<std::int64_t> numbers;
    for_each_line(content, [&](std::string_view line, std::size_t number) {
        const auto value = mesh_io::parse_integer(line);
        if (!value || *value < -1 || *value > std::numeric_limits<std::int32_t>::max())
            fail_line(name, number, fmt::format("a label number is expected, not {}", mesh_io::quote(line)));
        numbers.push_back(*value);
    });
    if (numbers.empty()) fail(name, "the file has no labels");
    return labels_of_numbers(numbers, {}, mesh, name);
}

std::vector<std::string> read_name_lines(std::string_view content, const std::string& name) {
    std::vector<std::string> names;
    for_each_line(content, [&](std::string_view line, std::size_t number) {
        if (!mesh_io::is_label_name(line))
            fail_line(name, number, fmt::format("no label can have the name {}", mesh_io::quote(line)));
        names.emplace_back(line);
    });
    return names;
}

FaceLabels read_segments(std::string_view content, const std::vector<std::string>& names, const TriangleMesh& mesh,
                         const std::string& name) {
    if (!is_number_list(content)) return labels_of_names(content, mesh, name);
    FaceLabels labels;
    const std::size_t faces = mesh_io::source_faces(mesh);
    std::int32_t most = -1;
    for_each_line(content, [&](std::string_view line, std::size_t number) {
        const auto value = mesh_io::parse_integer(line);
        const auto limit = static_cast<std::int64_t>(names.empty() ? faces : names.size());
        if (!value || *value < 0 || (!names.empty() && *value >= limit))
            fail_line(name, number,
                      fmt::format("segment {} has no name, since there are {}", mesh_io::quote(line), limit));
        if (*value >= static_cast<std::int64_t>(faces))
            fail_line(name, number, fmt::format("segment {} of a mesh of {} faces", mesh_io::quote(line), faces));
        if (labels.label.size() == faces) fail_line(name, number, fmt::format("the mesh has only {} faces", faces));
        labels.label.push_back(static_cast<std::int32_t>(*value));
        most = std::max(most, labels.label.back());
    });
    if (labels.label.size() != faces)
        fail(name, fmt::format("has {} lines, but the mesh has {} faces", labels.label.size(), faces));
    labels.names = names;
    for (auto i = static_cast<std::int32_t>(names.size()); i <= most; ++i)
        labels.names.push_back(fmt::format("segment {}", i));
    return labels;
}

}  // namespace exemplar::label_files
