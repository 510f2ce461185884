#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace exemplar {

/// Results of Kalogerakis' thesis (2010, Table 3.1) for a category of the Princeton Segmentation Benchmark: means
/// over the test meshes of five random training sets (for 19 training meshes: over leave-one-out).
struct ThesisRates {
    double recognition_rate;  ///< in [0, 1]
    double rand_error;        ///< against all human segmentations, in [0, 1]
};

/// Returns the rates of `category`, which may have a suffix ("Cup-train"). Nothing for other categories, or for
/// numbers of training meshes other than 3, 6, 12 and 19.
std::optional<ThesisRates> thesis_rates(std::string_view category, std::size_t training_meshes);

}  // namespace exemplar
