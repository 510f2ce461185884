// The lines o, g and usemtl of OBJ files, as Blender and others write them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/label_files/label_formats.h"

namespace exemplar::label_files {
namespace {

/// The names that faces get from one kind of line.
struct GroupKind {
    std::string_view keyword;
    std::vector<std::string> names;
    std::vector<std::int32_t> label;  ///< per face of the file; -1 before the first name
    std::int32_t current = -1;
    std::map<std::string, std::int32_t, std::less<>> index;

    void start(std::string_view group) {
        const auto [it, is_new] = index.try_emplace(std::string(group), static_cast<std::int32_t>(names.size()));
        if (is_new) names.emplace_back(group);
        current = it->second;
    }
    std::size_t used_names() const { return std::set<std::int32_t>(label.begin(), label.end()).size(); }
};

/// Reads the names of all kinds in one pass.
std::array<GroupKind, 3> read_kinds(std::string_view content, const std::string& name) {
    std::array<GroupKind, 3> kinds{{{"g", {}, {}, -1, {}}, {"usemtl", {}, {}, -1, {}}, {"o", {}, {}, -1, {}}}};
    mesh_io::TextCursor lines(content, name, '#');
    while (lines.next_line()) {
        std::string_view line = lines.rest();
        const std::string_view keyword = mesh_io::take_word(line);
        const bool is_continued = line.ends_with('\\');
        if (keyword == "f")
            for (GroupKind& kind : kinds) kind.label.push_back(kind.current);
        const auto kind = std::ranges::find(kinds, keyword, &GroupKind::keyword);
        if (kind != kinds.end()) {
            const std::string_view group = mesh_io::trimmed(line);
            const bool is_name = mesh_io::is_label_name(group);
            if (!is_name && !group.empty())
                fail(fmt::format("{}:{}", name, lines.line_number()),
                     fmt::format("no label can have the name {}", mesh_io::quote(group)));
            kind->start(is_name ? group : "default");
        }
        for (bool more = is_continued; more && lines.next_line();) more = lines.rest().ends_with('\\');
    }
    return kinds;
}

}  // namespace

FaceLabels read_obj_groups(std::string_view content, const TriangleMesh& mesh, const std::string& name) {
    std::array<GroupKind, 3> kinds = read_kinds(content, name);
    auto best = std::ranges::find_if(kinds, [](const GroupKind& kind) { return kind.used_names() > 1; });
    if (best == kinds.end())
        best = std::ranges::find_if(kinds, [](const GroupKind& kind) { return !kind.names.empty(); });
    if (best == kinds.end()) fail(name, "has no groups (g), materials (usemtl) or objects (o) that name its faces");
    if (best->label.size() != mesh_io::source_faces(mesh))
        fail(name, fmt::format("has {} faces, but the mesh has {}", best->label.size(), mesh_io::source_faces(mesh)));
    return {std::move(best->names), std::move(best->label)};
}

}  // namespace exemplar::label_files
