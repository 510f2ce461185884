#include "apps/exemplar/label/category_folders.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

#include "apps/exemplar/arguments.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// Labels lie beside a mesh, or in the mesh file itself.
bool may_be_labeled(const fs::path& file) {
    const std::string extension = file.extension().string();
    return file.filename().string().ends_with("_labels.txt") || extension == ".ply" || extension == ".glb";
}

bool holds(const fs::path& folder, bool (*kind)(const fs::path&)) {
    return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(),
                       [&](const fs::directory_entry& entry) { return entry.is_regular_file() && kind(entry.path()); });
}

}  // namespace

std::vector<fs::path> category_folders(const fs::path& folder, const fs::path& labels) {
    require_input(folder);
    if (!fs::is_directory(folder)) throw UsageError(fmt::format("{}: is no folder", folder.string()));
    std::set<fs::path> categories;
    if (!holds(folder, is_mesh_file))
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.is_directory() && holds(entry.path(), labels.empty() ? may_be_labeled : is_mesh_file))
                categories.insert(entry.path());
    if (categories.empty()) categories.insert(folder);
    return {categories.begin(), categories.end()};
}

fs::path without_trailing_slash(const fs::path& path) {
    const fs::path absolute = fs::absolute(path).lexically_normal();
    return absolute.has_filename() ? absolute : absolute.parent_path();
}

}  // namespace exemplar
