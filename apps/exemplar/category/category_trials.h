#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/exemplar/category/category_shapes.h"
#include "host/labeling/evaluation/evaluation.h"

namespace exemplar {

/// Either sources to split, or sources to train on and sources to test.
struct CategoryTrialOptions {
    std::vector<std::string> sources, train, test;
    std::size_t train_count = 6, splits = 1;
};

/// The meshes of all categories, and the training and test meshes of each split, numbered across all categories.
struct CategoryTrials {
    std::vector<CategoryMeshes> categories;
    std::vector<Split> splits;
    std::vector<std::string> remarks;  ///< what is not tested, and why

    std::vector<std::filesystem::path> paths() const;
};

/// Makes the trials, and rejects what would fail after the long work: reads all meshes, but computes nothing. Leaves
/// out test meshes of the same content as a training mesh of any category, with a remark; rejects the same file in
/// both. Throws UsageError or DataError naming what is missing or cannot be learned, and MeshError for an unreadable
/// mesh.
CategoryTrials make_category_trials(const CategoryTrialOptions& options, std::uint64_t seed);

}  // namespace exemplar
