#include "host/labeling/category/category_evaluation.h"

#include <algorithm>

#include "host/core/errors.h"

namespace exemplar {
namespace {

/// Returns the shapes `chosen` except those of category `left_out` (-1: none), with categories renumbered from 0.
CategorizedShapes subset(const CategorizedShapes& all, const std::vector<std::size_t>& chosen, std::int32_t left_out) {
    CategorizedShapes part;
    part.category_names = all.category_names;
    if (left_out >= 0) part.category_names.erase(part.category_names.begin() + left_out);
    part.feature_options = all.feature_options;
    for (const std::size_t i : chosen) {
        if (all.category[i] == left_out) continue;
        part.shapes.push_back(all.shapes[i]);
        part.category.push_back(all.category[i] - (left_out >= 0 && all.category[i] > left_out ? 1 : 0));
        part.provenance.push_back(all.provenance[i]);
    }
    return part;
}

RecognizedShape recognized(const CategoryModel& model, const CategorizedShapes& all, std::size_t shape,
                           std::int32_t left_out) {
    const CategoryPrediction prediction = recognize(model, all.shapes[shape]);
    const auto of_all = [&](std::int32_t category) { return category + (left_out >= 0 && category >= left_out); };
    const auto most = std::ranges::max_element(prediction.probability) - prediction.probability.begin();
    return {shape, prediction.category < 0 ? -1 : of_all(prediction.category), of_all(static_cast<std::int32_t>(most)),
            prediction.confidence};
}

/// Returns whether the other categories can be learned without this one.
bool can_be_left_out(std::vector<std::string> names, std::vector<std::size_t> counts, std::int32_t category) {
    names.erase(names.begin() + category);
    counts.erase(counts.begin() + category);
    try {
        require_category_sizes(names, counts);
        return true;
    } catch (const UsageError&) {
        return false;
    }
}

}  // namespace

std::vector<std::int32_t> indispensable_categories(std::span<const std::string> names,
                                                   std::span<const std::int32_t> category, const Split& split) {
    std::vector<std::size_t> counts(names.size(), 0);
    for (const std::size_t i : split.train) ++counts[static_cast<std::size_t>(category[i])];
    require_category_sizes(names, counts);
    std::vector<std::int32_t> needed;
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(names.size()); ++c)
        if (!can_be_left_out({names.begin(), names.end()}, counts, c)) needed.push_back(c);
    return needed;
}

CategoryTest test_categories(const CategorizedShapes& all, const Split& split, const CategoryTrainingOptions& options) {
    CategoryTest test;
    const std::vector<std::int32_t> needed = indispensable_categories(all.category_names, all.category, split);
    const CategoryModel model = train_categories(subset(all, split.train, -1), options, test.training);
    for (const std::size_t i : split.test) test.shapes.push_back(recognized(model, all, i, -1));
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(all.category_names.size()); ++c) {
        if (std::ranges::binary_search(needed, c)) continue;
        CategoryReport ignored;
        const CategoryModel without = train_categories(subset(all, split.train, c), options, ignored);
        for (const std::size_t i : split.test)
            if (all.category[i] == c) test.strangers.push_back(recognized(without, all, i, c));
    }
    return test;
}

std::vector<std::size_t> category_confusion(const CategorizedShapes& all, const std::vector<RecognizedShape>& tested) {
    const std::size_t categories = all.category_names.size();
    std::vector<std::size_t> counts(categories * (categories + 1), 0);
    for (const RecognizedShape& shape : tested) {
        const auto truth = static_cast<std::size_t>(all.category[shape.shape]);
        ++counts[truth * (categories + 1) + (shape.called < 0 ? categories : static_cast<std::size_t>(shape.called))];
    }
    return counts;
}

}  // namespace exemplar
