#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/labeling/category/category_training.h"
#include "host/labeling/evaluation/evaluation.h"

namespace exemplar {

/// The prediction for a shape that the model did not see in training.
struct RecognizedShape {
    std::size_t shape = 0;                   ///< index into the evaluated shapes
    std::int32_t called = -1, nearest = -1;  ///< answer (-1: unknown) and most probable category (never -1)
    float confidence = 0;
};

/// The tests of one split.
struct CategoryTest {
    std::vector<RecognizedShape> shapes;  ///< the tested shapes, in the order of the split
    /// The same shapes, each by a model that was trained without its category; except those of a category that cannot
    /// be left out (see indispensable_categories).
    std::vector<RecognizedShape> strangers;
    CategoryReport training;
};

/// Returns the categories that cannot be left out because the shapes of the others alone cannot be learned, in order.
/// Needs no features, only the category of each shape. Throws UsageError if the shapes of split.train cannot be
/// learned (see require_category_sizes).
std::vector<std::int32_t> indispensable_categories(std::span<const std::string> names,
                                                   std::span<const std::int32_t> category, const Split& split);

/// Trains on the shapes of split.train and recognizes those of split.test. Throws what train_categories throws.
CategoryTest test_categories(const CategorizedShapes& all, const Split& split, const CategoryTrainingOptions& options);

/// Counts the tested shapes: categories x (categories + 1); row = truth, last column = called unknown.
std::vector<std::size_t> category_confusion(const CategorizedShapes& all, const std::vector<RecognizedShape>& tested);

}  // namespace exemplar
