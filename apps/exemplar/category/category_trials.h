#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/exemplar/category/category_shapes.h"
#include "host/labeling/evaluation/evaluation.h"

namespace exemplar {

/// Either sources to split, or those to train on and to test.
struct CategoryTrialOptions {
    std::vector<std::string> sources, train, test;
    std::size_t train_count = 6, splits = 1;
};

/// The meshes of all categories, and which of them are trained on and tested, numbered through all categories.
struct CategoryTrials {
    std::vector<CategoryMeshes> categories;
    std::vector<Split> splits;
    std::vector<std::string> remarks;  ///< what is not tested, and why

    std::vector<std::filesystem::path> paths() const;
};

/// Makes the trials, and refuses what would fail after the long work: it reads all meshes, but computes nothing. A mesh
/// of the same content as one that is trained on, in whatever category, would not test anything: it is left out, with a
/// remark; the same file is refused. Throws UsageError or DataError saying what is missing or cannot be learned, and
/// MeshError for a mesh that cannot be read.
CategoryTrials make_category_trials(const CategoryTrialOptions& options, std::uint64_t seed);

}  // namespace exemplar
