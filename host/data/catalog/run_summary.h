#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "host/data/catalog/catalog.h"

namespace exemplar {

// Statistics of the results of a labeling run, computed by the database: a run may have any number of shapes.

/// The shapes of one category (given or recognized), which one model labeled.
struct CategorySummary {
    std::string category;  ///< empty if it was neither given nor recognized
    std::string model;     ///< the model that labeled them; empty if none did
    std::int64_t done = 0, failed = 0, unknown = 0;
    std::int64_t recognized = 0;  ///< labeled shapes whose category was recognized, not given
    double confidence = std::numeric_limits<double>::quiet_NaN();  ///< mean over the labeled shapes, in [0, 1]
};
/// Returns at most `most` categories, those with most labeled shapes first.
std::vector<CategorySummary> summarize_categories(Catalog& catalog, std::int64_t run, std::size_t most);

/// One label within a category.
struct LabelSummary {
    std::string label;
    std::int64_t shapes = 0;  ///< number of shapes that have it
    double area = 0;          ///< mean share of the area over all labeled shapes of the category
    double confidence = 0;    ///< mean over the shapes that have it
};
/// Returns at most `most` labels of a category, those with the largest area first.
std::vector<LabelSummary> summarize_labels(Catalog& catalog, std::int64_t run, const std::string& category,
                                           std::size_t most);

/// The time spent in one stage of the work.
struct StageSummary {
    std::string stage;
    std::int64_t shapes = 0;
    double seconds = 0;  ///< summed over all shapes
};
/// Returns the stages, those with most time first.
std::vector<StageSummary> summarize_stages(Catalog& catalog, std::int64_t run);

/// Mean confidence of all labeled shapes (NaN if there are none), and the time when the last was finished.
struct RunTotals {
    double confidence = std::numeric_limits<double>::quiet_NaN();
    double last_finished = std::numeric_limits<double>::quiet_NaN();  ///< seconds since 1970
};
RunTotals summarize_run(Catalog& catalog, std::int64_t run);

/// Chooses labeled shapes of a category as examples: the numbers of the `uncertain` ones, and of `others` more,
/// spread evenly over the rest in order of confidence up to the surest one, without repetition. Considers only
/// shapes of at most `max_faces` faces.
std::vector<std::int64_t> example_shapes(Catalog& catalog, std::int64_t run, const std::string& category,
                                         std::size_t uncertain, std::size_t others, std::int64_t max_faces);

}  // namespace exemplar
