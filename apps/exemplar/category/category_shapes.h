#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/labeling/category/category_training.h"

namespace exemplar {

/// The meshes of a category.
struct CategoryMeshes {
    std::string name;
    std::vector<std::filesystem::path> meshes;
};

/// What SOURCE says of a category's meshes.
extern const char* const k_category_source_help;

/// Categories in the order in which they come, those of equal names as one, a mesh once. An argument is NAME=SOURCE
/// (a folder, list or mesh file), a folder of meshes, whose name is the category, or a folder of such folders. Throws
/// DataError or UsageError saying what is missing.
std::vector<CategoryMeshes> categories_of_arguments(const std::vector<std::string>& arguments);

/// Reads all meshes and describes them, with progress. Throws MeshError naming the first that cannot be used.
CategorizedShapes describe_categories(const std::vector<CategoryMeshes>& categories, const FeatureOptions& options,
                                      const std::filesystem::path& cache, bool quiet);

/// Adds the options of a training, of its features and of the memory of these to a subcommand.
void add_category_options(CLI::App& command, CategoryTrainingOptions& training, FeatureOptions& features,
                          std::filesystem::path& cache);

/// What was measured on held-out shapes, as text and for --json.
void print_category_report(const CategoryReport& report);
nlohmann::json describe_category_report(const CategoryReport& report);

}  // namespace exemplar
