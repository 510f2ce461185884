#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "host/data/catalog/catalog.h"

namespace exemplar {

// What became of the shapes of a labeling run, in numbers that the database adds up: a run may have any number of
// shapes.

/// The shapes of one category, given or recognized; the same model labeled all of them.
struct CategorySummary {
    std::string category;  ///< empty where none was given and none looked for
    std::string model;     ///< that labeled them; empty if none were
    std::int64_t done = 0, failed = 0, unknown = 0;
    std::int64_t recognized = 0;  ///< of those done, the ones whose category was not given
    double confidence = std::numeric_limits<double>::quiet_NaN();  ///< mean over those done, in [0, 1]
};
/// At most `most` categories, those with most labeled shapes first.
std::vector<CategorySummary> summarize_categories(Catalog& catalog, std::int64_t run, std::size_t most);

/// One label within a category.
struct LabelSummary {
    std::string label;
    std::int64_t shapes = 0;  ///< that have it
    double area = 0;          ///< share of the area, mean over all labeled shapes of the category
    double confidence = 0;    ///< mean over the shapes that have it
};
/// At most `most` labels of a category, those with most area first.
std::vector<LabelSummary> summarize_labels(Catalog& catalog, std::int64_t run, const std::string& category,
                                           std::size_t most);

/// The time that a stage of the work took.
struct StageSummary {
    std::string stage;
    std::int64_t shapes = 0;
    double seconds = 0;  ///< of all of them together
};
/// Those with most time first.
std::vector<StageSummary> summarize_stages(Catalog& catalog, std::int64_t run);

/// How sure all labeled shapes are in the mean (NaN if there are none), and when the last was finished.
struct RunTotals {
    double confidence = std::numeric_limits<double>::quiet_NaN();
    double last_finished = std::numeric_limits<double>::quiet_NaN();  ///< seconds since 1970
};
RunTotals summarize_run(Catalog& catalog, std::int64_t run);

/// Labeled shapes of a category as examples: numbers of the `least_sure` ones, and of `others` spread evenly over the
/// order of confidence up to the surest one, none twice. Only shapes of at most `most_faces` faces count.
std::vector<std::int64_t> example_shapes(Catalog& catalog, std::int64_t run, const std::string& category,
                                         std::size_t least_sure, std::size_t others, std::int64_t most_faces);

}  // namespace exemplar
