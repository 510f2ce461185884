#include "apps/exemplar/category/category_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "apps/exemplar/arguments.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/text.h"
#include "host/data/corpus.h"
#include "host/data/result_cache.h"
#include "host/labeling/category/descriptor_cache.h"

namespace exemplar {

namespace fs = std::filesystem;

const char* const k_category_source_help =
    "folders of meshes, each named as its category; folders of such folders; or NAME=SOURCE with a folder, a list "
    "(.txt, a path a line) or a mesh";

namespace {

bool holds_meshes(const fs::path& folder) {
    return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(),
                       [](const auto& entry) { return entry.is_regular_file() && is_mesh_file(entry.path()); });
}

std::string folder_name(const fs::path& folder) {
    const fs::path absolute = fs::absolute(folder).lexically_normal();
    return (absolute.has_filename() ? absolute : absolute.parent_path()).filename().string();
}

/// Folders in `folder` that hold meshes, in natural order.
std::vector<fs::path> folders_of_meshes(const fs::path& folder) {
    std::vector<fs::path> folders;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_directory() && holds_meshes(entry.path())) folders.push_back(entry.path());
    std::ranges::sort(folders, [](const fs::path& a, const fs::path& b) {
        return natural_less(a.filename().string(), b.filename().string());
    });
    return folders;
}

std::vector<CategoryMeshes> categories_of_argument(const std::string& argument) {
    const std::size_t equals = argument.find('=');
    std::error_code ignored;  // a name that the system refuses is no file
    if (equals != std::string::npos && equals > 0 && !fs::exists(argument, ignored))
        return {{argument.substr(0, equals), meshes_of_argument(argument.substr(equals + 1))}};
    require_input(argument);
    if (!fs::is_directory(argument))
        throw UsageError(
            fmt::format("{}: is no folder, so its category has no name; write NAME={}", argument, argument));
    if (holds_meshes(argument)) return {{folder_name(argument), list_meshes(argument)}};
    std::vector<CategoryMeshes> categories;
    for (const fs::path& folder : folders_of_meshes(argument))
        categories.push_back({folder_name(folder), list_meshes(folder)});
    if (categories.empty()) throw DataError(fmt::format("{}: holds neither meshes nor folders of meshes", argument));
    return categories;
}

}  // namespace

std::vector<CategoryMeshes> categories_of_arguments(const std::vector<std::string>& arguments) {
    std::vector<CategoryMeshes> categories;
    std::map<fs::path, std::string> category_of;
    for (const std::string& argument : arguments)
        for (CategoryMeshes& found : categories_of_argument(argument)) {
            auto category = std::ranges::find(categories, found.name, &CategoryMeshes::name);
            if (category == categories.end()) category = categories.insert(category, {found.name, {}});
            for (const fs::path& mesh : found.meshes) {
                const auto [known, fresh] = category_of.emplace(fs::weakly_canonical(mesh), found.name);
                if (fresh) category->meshes.push_back(mesh);
                if (known->second != found.name)
                    throw UsageError(fmt::format("{}: is in two categories, {} and {}; leave it out of one",
                                                 mesh.string(), known->second, found.name));
            }
        }
    return categories;
}

CategorizedShapes describe_categories(const std::vector<CategoryMeshes>& categories, const FeatureOptions& options,
                                      const fs::path& cache, bool quiet) {
    std::size_t count = 0;
    for (const CategoryMeshes& category : categories) count += category.meshes.size();
    Progress progress("describing shapes", count);
    std::map<std::string, std::pair<std::string, fs::path>> first_of;  // content to category and file
    CategorizedShapes result;
    result.feature_options = options;
    for (const CategoryMeshes& category : categories) {
        result.category_names.push_back(category.name);
        for (const fs::path& path : category.meshes) {
            check_interrupt();
            const MeshFile file = read_mesh(path);
            mesh_warnings(file, path, quiet);
            result.shapes.push_back(of_file(path, [&] { return cached_shape_descriptor(file.mesh, options, cache); }));
            result.category.push_back(static_cast<std::int32_t>(result.category_names.size() - 1));
            const std::string hash = content_hash(file.mesh);
            const auto first = first_of.emplace(hash, std::pair(category.name, path)).first;
            if (first->second.first != category.name && !quiet)
                fmt::print(stderr, "warning: {}: has the same content as {}, which is in category {}\n", path.string(),
                           first->second.second.string(), first->second.first);
            result.provenance.push_back(fmt::format("{} {} {}", category.name, path.stem().string(), hash));
            progress.advance(1, path.filename().string());
        }
    }
    progress.finish();
    return result;
}

void add_category_options(Command& command, CategoryTrainingOptions& training, FeatureOptions& features,
                          fs::path& cache) {
    command.add_option("--seed", training.seed, "seed of all random choices; equal seeds give equal model files")
        ->capture_default_str()
        ->check(whole_number(0));
    command.add_option("--samples", features.samples, "faces that stand for the surface in distance statistics")
        ->capture_default_str()
        ->check(whole_number(1, k_max_samples));
    command
        .add_option("--least-confidence", training.min_confidence,
                    "a shape of less is called unknown, from 0 (never) to 1")
        ->capture_default_str()
        ->check(in_range(0.0, 1.0))
        ->type_name("SHARE");
    command.add_option("--cache", cache, "folder that remembers what shapes are like; '' remembers nothing")
        ->capture_default_str()
        ->type_name("FOLDER");
}

void print_category_report(const CategoryReport& report) {
    fmt::print(
        "held-out shapes: {:.1f} % right, {:.1f} % wrong, {:.1f} % called unknown; the nearest category is theirs for "
        "{:.1f} %\n",
        100 * report.right, 100 * std::max(0.0, 1 - report.right - report.called_unknown), 100 * report.called_unknown,
        100 * report.nearest_right);
    fmt::print("{}: {:.1f} % called unknown\n",
               report.strangers_made_up ? "means of shapes of both categories" : "shapes of held-out categories",
               100 * report.strangers_unknown);
}

nlohmann::json describe_category_report(const CategoryReport& report) {
    return {{"right", report.right},
            {"called_unknown", report.called_unknown},
            {"nearest_right", report.nearest_right},
            {"strangers_unknown", report.strangers_unknown},
            {"strangers_made_up", report.strangers_made_up}};
}

}  // namespace exemplar
