#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace exemplar {

/// What Kalogerakis' thesis (2010, Table 3.1) reports of a category of the Princeton Segmentation Benchmark: means over
/// the meshes that were not trained on, of five random training sets (of each mesh left out, with 19 to train on).
struct ThesisRates {
    double recognition_rate;  ///< in [0, 1]
    double rand_error;        ///< against all human segmentations, in [0, 1]
};

/// The rates of `category`, or of a name that begins with it ("Cup-train"); nothing for other categories or another
/// number of training meshes than 3, 6, 12 or 19.
std::optional<ThesisRates> thesis_rates(std::string_view category, std::size_t training_meshes);

}  // namespace exemplar
