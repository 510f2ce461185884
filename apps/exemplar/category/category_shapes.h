#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/help/command.h"
#include "host/labeling/category/category_training.h"

namespace exemplar {

/// The meshes of a category.
struct CategoryMeshes {
    std::string name;
    std::vector<std::filesystem::path> meshes;
};

/// Help text on SOURCE, the meshes of a category.
extern const char* const k_category_source_help;

/// Returns categories in the order of the arguments; merges those of equal names and lists each mesh once. An
/// argument is NAME=SOURCE (a folder, list or mesh file), a folder of meshes, whose name is the category, or a
/// folder of such folders. Throws DataError or UsageError naming what is missing.
std::vector<CategoryMeshes> categories_of_arguments(const std::vector<std::string>& arguments);

/// Reads all meshes and computes their descriptors, with progress. Throws MeshError naming the first unusable mesh.
CategorizedShapes describe_categories(const std::vector<CategoryMeshes>& categories, const FeatureOptions& options,
                                      const std::filesystem::path& cache, bool quiet);

/// Adds the options of training, of its features and of their cache to a subcommand.
void add_category_options(Command& command, CategoryTrainingOptions& training, FeatureOptions& features,
                          std::filesystem::path& cache);

/// Results on held-out shapes, as text and for --json.
void print_category_report(const CategoryReport& report);
nlohmann::json describe_category_report(const CategoryReport& report);

}  // namespace exemplar
