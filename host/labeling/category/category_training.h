#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/labeling/category/category_model.h"

namespace exemplar {

/// Descriptors of shapes whose category is known.
struct CategorizedShapes {
    std::vector<std::string> category_names;
    FeatureOptions feature_options;       ///< of the features that descriptors are computed from
    std::vector<ShapeDescriptor> shapes;  ///< all with the same features
    std::vector<std::int32_t> category;   ///< per shape: index into the names
    std::vector<std::string> provenance;  ///< per shape: a line for the model file
};

struct CategoryTrainingOptions {
    std::uint64_t seed = 1;       ///< of all random choices
    double min_confidence = 0.5;  ///< of the model: shapes with a lower confidence are called unknown; in [0, 1]
};

/// How well held-out shapes were recognized. Shares are means over the categories, in [0, 1].
struct CategoryReport {
    double right = 0;              ///< share of held-out shapes of known categories that were called by their category
    double called_unknown = 0;     ///< share of these that were called unknown
    double nearest_right = 0;      ///< share of these whose most probable category is theirs, at any confidence
    double strangers_unknown = 0;  ///< share called unknown of shapes whose whole category was held out
    bool strangers_made_up = false;  ///< with only two categories: the strangers are means of two shapes
};

/// Throws UsageError unless categories of these names and numbers of shapes can be learned: the names pass
/// require_category_names, each category has a shape, and one has at least two (otherwise nothing shows how alike the
/// shapes of a category are).
void require_category_sizes(std::span<const std::string> names, std::span<const std::size_t> counts);
/// Throws UsageError unless the confidence is in [0, 1].
void require_min_confidence(double min_confidence);

/// Trains a model by ridge regression of the squashed descriptors (see CategoryScores) on one target per category.
/// All categories have the same total weight, however many shapes they have.
///
/// Held-out shapes calibrate the confidence, a logistic function of the evidence: shapes of the categories, in up to
/// ten folds drawn at random (by seed), and "strangers", for which their whole category is held out. It assumes that
/// one shape in five is a stranger. The only shape of a category is in no fold. With two categories, none can be held
/// out: means of descriptors of both stand for strangers, a weak substitute. options.min_confidence is stored in the
/// model and changes nothing else of it. docs/labeling.md explains the choices.
///
/// Throws UsageError for what require_category_sizes and require_min_confidence refuse, and for shapes with
/// different features.
CategoryModel train_categories(const CategorizedShapes& training, const CategoryTrainingOptions& options,
                               CategoryReport& report);

}  // namespace exemplar
