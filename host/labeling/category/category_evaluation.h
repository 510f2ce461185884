#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/labeling/category/category_training.h"
#include "host/labeling/evaluation/evaluation.h"

namespace exemplar {

/// What a model said of a shape that it did not see in training.
struct RecognizedShape {
    std::size_t shape = 0;                   ///< index into those evaluated
    std::int32_t called = -1, nearest = -1;  ///< categories of all; called is -1 for unknown, nearest never
    float confidence = 0;
};

/// One training and the tests of what it learned.
struct CategoryTest {
    std::vector<RecognizedShape> shapes;  ///< those tested, in the order of the split
    /// The same shapes, each by a model that was trained without any of its category; not those of a category that
    /// cannot be left out.
    std::vector<RecognizedShape> strangers;
    CategoryReport training;
};

/// What can be told before any feature is computed, from the category of each shape: throws UsageError if the shapes of
/// split.train cannot be learned from (see require_category_sizes), and returns the categories that cannot be left out
/// because the shapes of the others cannot be learned from, in order.
std::vector<std::int32_t> categories_needed(std::span<const std::string> names, std::span<const std::int32_t> category,
                                            const Split& split);

/// Trains on the shapes of split.train and recognizes those of split.test. Throws what train_categories throws.
CategoryTest test_categories(const CategorizedShapes& all, const Split& split, const CategoryTrainingOptions& options);

/// Counts of tested shapes, categories x (categories + 1): row = truth; the last column = called unknown.
std::vector<std::size_t> category_confusion(const CategorizedShapes& all, const std::vector<RecognizedShape>& tested);

}  // namespace exemplar
