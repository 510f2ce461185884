#include "host/hatching/style/example_features.h"

#include <algorithm>
#include <numeric>

#include "host/hatching/features/expanded_features.h"
#include "host/hatching/style/pixel_classifier.h"

namespace exemplar {

std::vector<std::uint32_t> numbers_from(std::size_t first, std::size_t end) {
    std::vector<std::uint32_t> all(end - first);
    std::iota(all.begin(), all.end(), static_cast<std::uint32_t>(first));
    return all;
}

/// Returns the contextual features of rows of a view, of all if there are none.
FeatureMatrix ExampleFeatures::context_of_view(std::size_t view, std::span<const std::uint32_t> rows,
                                               const SegmentContext& context) const {
    PixelFeatures& pixels = views_.views()[view].pixels;
    return contextual_features(pixels.surface(), pixels.gbuffer(), pixels.pixels(),
                               of_view(view, context.probabilities, context.segments), context.segments, rows);
}

FeatureMatrix ExampleFeatures::context_of_rows(std::span<const std::uint32_t> rows,
                                               const SegmentContext& context) const {
    FeatureMatrix out;
    out.rows = rows.size();
    for (std::string& name : contextual_feature_names(context.segments)) out.add(std::move(name));
    for (std::size_t view = 0; view < views_.views().size(); ++view) {
        const HatchingExamples::RowsOfView some = views_.rows_of_view(rows, view);
        if (some.row.empty()) continue;
        const FeatureMatrix of_view = context_of_view(view, some.row, context);
        for (std::size_t k = 0; k < out.cols(); ++k) {
            for (std::size_t i = 0; i < some.position.size(); ++i)
                out.column(k)[some.position[i]] = of_view.column(k)[i];
        }
    }
    return out;
}

FeatureMatrix ExampleFeatures::of_rows(std::span<const std::uint32_t> rows, const SegmentContext& context) const {
    const std::size_t contextual = contextual_feature_count(context.segments);
    FeatureMatrix features = views_.scalars(numbers_from(0, views_.scalar_count()), rows, contextual);
    if (contextual > 0) features.append(context_of_rows(rows, context));
    return features;
}

std::vector<std::vector<float>> ExampleFeatures::probabilities(std::span<const CalibratedStumps> classifiers,
                                                               const SegmentContext& context) const {
    std::vector<std::uint32_t> used;
    for (const CalibratedStumps& classifier : classifiers) {
        const std::vector<std::uint32_t> some = used_features(classifier.stumps);
        used.insert(used.end(), some.begin(), some.end());
    }
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    const std::size_t scalars = views_.scalar_count();
    const auto first_context = std::ranges::lower_bound(used, static_cast<std::uint32_t>(scalars));
    const std::size_t contextual = first_context == used.end() ? 0 : contextual_feature_count(context.segments);
    std::vector<std::uint32_t> which(used.begin(), first_context);
    const std::size_t base = which.size();
    for (const std::uint32_t k : numbers_from(scalars, scalars + contextual)) which.push_back(k);

    std::vector<std::vector<float>> all(classifiers.size());
    for (std::size_t view = 0; view < views_.views().size(); ++view) {
        FeatureMatrix features = views_.views()[view].pixels.scalars(std::span(which).first(base), {}, contextual);
        if (contextual > 0) features.append(context_of_view(view, {}, context));
        for (std::size_t c = 0; c < classifiers.size(); ++c) {
            const std::vector<float> some = classify(classifiers[c], which, features, scorer_);
            all[c].insert(all[c].end(), some.begin(), some.end());
        }
    }
    return all;
}

}  // namespace exemplar
