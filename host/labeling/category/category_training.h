#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/labeling/category/category_model.h"

namespace exemplar {

/// Shapes whose category is known, with their descriptors.
struct CategorizedShapes {
    std::vector<std::string> category_names;
    FeatureOptions feature_options;       ///< of the features that descriptors are of
    std::vector<ShapeDescriptor> shapes;  ///< all of the same features
    std::vector<std::int32_t> category;   ///< per shape, index into the names
    std::vector<std::string> provenance;  ///< per shape, a line for the model file
};

struct CategoryTrainingOptions {
    std::uint64_t seed = 1;         ///< of all random choices
    double least_confidence = 0.5;  ///< of the model: a shape of less is called unknown; in [0, 1]
};

/// How well shapes that were held out were recognized; shares are means over the categories, in [0, 1].
struct CategoryReport {
    double right = 0;              ///< of held-out shapes of the categories: those called by their category
    double called_unknown = 0;     ///< of these: those called unknown
    double nearest_right = 0;      ///< of these: those whose most probable category is theirs, whatever its confidence
    double strangers_unknown = 0;  ///< of shapes of a category that was held out with all of its shapes: called unknown
    bool strangers_made_up = false;  ///< two categories: the strangers are means of two shapes
};

/// Throws UsageError unless categories of these names with so many shapes each can be learned: names that can be (see
/// require_category_names), none without shapes, and one with two, or nothing would tell how alike its shapes are.
void require_category_sizes(std::span<const std::string> names, std::span<const std::size_t> counts);
/// Throws UsageError unless it is from 0 to 1.
void require_least_confidence(double least_confidence);

/// Learns to recognize categories: ridge regression of the squashed descriptors (see CategoryScores) on a target per
/// category, all categories with the same total weight however many shapes they have.
///
/// What is said of shapes that were held out calibrates the model: each category's shapes fall at random (by seed) into
/// up to ten folds, held out in turn (one shape of a category alone is never); and each category is held out whole, so
/// that its shapes stand for all categories that are not learned. A logistic regression on the evidence then gives the
/// confidence that the answer is right, one shape in five being a stranger; from the least confidence on it is trusted,
/// which changes nothing else of the model. With only two categories none can be held out: means of descriptors of both
/// stand for strangers, a weak substitute.
///
/// Throws UsageError for what require_category_sizes and require_least_confidence refuse, and for shapes of different
/// features.
CategoryModel train_categories(const CategorizedShapes& training, const CategoryTrainingOptions& options,
                               CategoryReport& report);

}  // namespace exemplar
