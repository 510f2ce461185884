#include "host/labeling/category/category_training.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/learn/boosting/calibration.h"
#include "host/learn/regression/logistic_regression.h"
#include "host/learn/regression/ridge.h"
#include "host/mesh/io/io_text.h"

namespace exemplar {
namespace {

using Indices = std::vector<std::size_t>;

/// See ridge_regression; the mean squared value of a squashed descriptor is at most 1.
constexpr double k_ridge = 0.05;
constexpr std::size_t k_max_category_folds = 10;
/// Assumed share of strangers among the shapes, for the confidence.
constexpr double k_stranger_share = 0.2;
/// With two categories: how many strangers are made from each shape. More would not help to fit the two parameters.
constexpr std::size_t k_max_pairs = 20;
/// A deviation below this share of the mean is rounding.
constexpr double k_min_variation = 1e-6;
/// Factor on the scores before `calibrate`, which searches scales in [0.02, 10].
constexpr float k_score_unit = 10;

struct Problem {
    const CategorizedShapes* training;
    std::size_t categories() const { return training->category_names.size(); }
    std::span<const float> descriptor(std::size_t shape) const { return training->shapes[shape].values; }
    std::size_t category(std::size_t shape) const { return static_cast<std::size_t>(training->category[shape]); }
};

/// Returns weights of the shapes with which all categories weigh the same; their mean is 1.
Eigen::VectorXd balanced_weights(const Problem& problem, const Indices& shapes) {
    std::vector<double> count(problem.categories(), 0);
    for (const std::size_t i : shapes) ++count[problem.category(i)];
    const auto present = static_cast<double>(std::ranges::count_if(count, [](double n) { return n > 0; }));
    Eigen::VectorXd weights(static_cast<Eigen::Index>(shapes.size()));
    for (std::size_t r = 0; r < shapes.size(); ++r)
        weights[static_cast<Eigen::Index>(r)] =
            static_cast<double>(shapes.size()) / (present * count[problem.category(shapes[r])]);
    return weights;
}

RowMajorMatrix matrix_of(const Problem& problem, const Indices& shapes) {
    const std::size_t values = problem.descriptor(0).size();
    RowMajorMatrix matrix(static_cast<Eigen::Index>(shapes.size()), static_cast<Eigen::Index>(values));
    for (std::size_t r = 0; r < shapes.size(); ++r)
        matrix.row(static_cast<Eigen::Index>(r)) =
            Eigen::Map<const Eigen::RowVectorXf>(problem.descriptor(shapes[r]).data(), matrix.cols()).cast<double>();
    return matrix;
}

/// Sets the squashing of CategoryScores to weighted means and deviations, and applies it to `matrix`.
void squash(RowMajorMatrix& matrix, const Eigen::VectorXd& weights, CategoryScores& scores) {
    const auto rows = static_cast<double>(matrix.rows());
    const Eigen::RowVectorXd mean = weights.transpose() * matrix / rows;
    matrix.rowwise() -= mean;
    const Eigen::RowVectorXd variance = weights.transpose() * matrix.cwiseAbs2() / rows;
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
        const double deviation = std::sqrt(variance[k]);
        const float inverse =
            deviation > k_min_variation * std::abs(mean[k]) ? static_cast<float>(1 / deviation) : 0.0F;
        const bool usable = std::isfinite(inverse);
        scores.mean.push_back(static_cast<float>(mean[k]));
        scores.inverse_deviation.push_back(usable ? inverse : 0.0F);
        matrix.col(k) = (matrix.col(k) * static_cast<double>(scores.inverse_deviation.back())).array().tanh();
    }
}

CategoryScores fit(const Problem& problem, const Indices& shapes) {
    CategoryScores scores;
    const Eigen::VectorXd weights = balanced_weights(problem, shapes);
    RowMajorMatrix z = matrix_of(problem, shapes);
    squash(z, weights, scores);
    const auto rows = z.rows(), categories = static_cast<Eigen::Index>(problem.categories());
    Eigen::MatrixXd target = Eigen::MatrixXd::Zero(rows, categories);
    for (Eigen::Index r = 0; r < rows; ++r)
        target(r, static_cast<Eigen::Index>(problem.category(shapes[static_cast<std::size_t>(r)]))) = 1;
    const Eigen::RowVectorXd offset = weights.transpose() * target / static_cast<double>(rows);
    target.rowwise() -= offset;

    const RowMajorMatrix found = ridge_regression(z, weights, target, k_ridge);
    for (const double value : found.reshaped<Eigen::RowMajor>()) scores.weights.push_back(static_cast<float>(value));
    for (const double value : offset) scores.offset.push_back(static_cast<float>(value));
    return scores;
}

/// Scores of a shape that the model had not seen.
struct HeldOutShape {
    std::size_t category = 0;
    bool stranger = false;  ///< of no category that the model knows
    std::vector<double> scores;
    double evidence = 0;

    std::size_t best() const { return static_cast<std::size_t>(std::ranges::max_element(scores) - scores.begin()); }
    bool right() const { return !stranger && best() == category; }
};

HeldOutShape held_out(std::size_t category, bool stranger, std::vector<double> scores) {
    HeldOutShape item{category, stranger, std::move(scores), 0};
    item.evidence = category_evidence(item.scores);
    return item;
}

bool are_equal(const Problem& problem, std::size_t a, std::size_t b) {
    return std::ranges::equal(problem.descriptor(a), problem.descriptor(b));
}

/// Returns the shapes of a category, grouped into copies of the same mesh.
std::vector<Indices> distinct_shapes(const Problem& problem, std::size_t category) {
    std::vector<Indices> distinct;
    for (std::size_t i = 0; i < problem.training->category.size(); ++i) {
        if (problem.category(i) != category) continue;
        const auto same = std::ranges::find_if(
            distinct, [&](const Indices& copies) { return are_equal(problem, copies.front(), i); });
        if (same == distinct.end())
            distinct.push_back({i});
        else
            same->push_back(i);
    }
    return distinct;
}

/// Returns the fold of each shape; copies are in the same fold. Shapes of a category with one distinct mesh are in
/// none (k_max_category_folds).
Indices make_category_folds(const Problem& problem, std::uint64_t seed) {
    Indices fold(problem.training->category.size(), k_max_category_folds);
    for (std::size_t c = 0; c < problem.categories(); ++c) {
        std::vector<Indices> members = distinct_shapes(problem, c);
        Random random = Random(seed).fork(c);
        random.shuffle(members);
        if (members.size() < 2) continue;
        for (std::size_t rank = 0; rank < members.size(); ++rank)
            for (const std::size_t i : members[rank]) fold[i] = rank % k_max_category_folds;
    }
    return fold;
}

std::vector<float> mean_vector(std::span<const float> a, std::span<const float> b) {
    std::vector<float> mean;
    for (std::size_t k = 0; k < a.size(); ++k) mean.push_back((a[k] + b[k]) / 2);
    return mean;
}

/// Returns shapes of categories other than that of `shape`, at most k_max_pairs.
Indices some_others(const Problem& problem, std::size_t shape, std::uint64_t seed) {
    Indices others;
    for (std::size_t j = 0; j < problem.training->category.size(); ++j)
        if (problem.category(j) != problem.category(shape)) others.push_back(j);
    if (others.size() <= k_max_pairs) return others;
    Random random = Random(seed).fork(shape);
    random.shuffle(others);
    others.resize(k_max_pairs);
    return others;
}

/// Scores a held-out fold: its shapes and, with two categories, their means with shapes of the other one as
/// strangers.
std::vector<HeldOutShape> hold_fold_out(const Problem& problem, const Indices& fold, std::size_t k,
                                        std::uint64_t seed) {
    Indices rest, out;
    for (std::size_t i = 0; i < fold.size(); ++i) (fold[i] == k ? out : rest).push_back(i);
    if (out.empty()) return {};
    const CategoryScores scores = fit(problem, rest);
    std::vector<HeldOutShape> items;
    for (const std::size_t i : out)
        items.push_back(held_out(problem.category(i), false, scores.of(problem.descriptor(i))));
    if (problem.categories() > 2) return items;
    for (const std::size_t i : out)
        for (const std::size_t j : some_others(problem, i, seed))
            items.push_back(held_out(problem.category(i), true,
                                     scores.of(mean_vector(problem.descriptor(i), problem.descriptor(j)))));
    return items;
}

/// Scores a category that is held out as a whole, except copies of shapes of other categories.
std::vector<HeldOutShape> hold_category_out(const Problem& problem, std::size_t category) {
    Indices rest, out;
    for (std::size_t i = 0; i < problem.training->category.size(); ++i)
        (problem.category(i) == category ? out : rest).push_back(i);
    const CategoryScores scores = fit(problem, rest);
    std::vector<HeldOutShape> items;
    for (const std::size_t i : out) {
        if (std::ranges::any_of(rest, [&](std::size_t j) { return are_equal(problem, i, j); })) continue;
        std::vector<double> of_shape = scores.of(problem.descriptor(i));
        of_shape.erase(of_shape.begin() + static_cast<std::ptrdiff_t>(category));  // the model does not know it
        items.push_back(held_out(category, true, std::move(of_shape)));
    }
    return items;
}

std::vector<HeldOutShape> hold_all_out(const Problem& problem, std::uint64_t seed) {
    const Indices fold = make_category_folds(problem, seed);
    const std::size_t whole = problem.categories() > 2 ? problem.categories() : 0;
    std::vector<std::vector<HeldOutShape>> parts(k_max_category_folds + whole);
    parallel_for(parts.size(), [&](std::size_t p) {
        parts[p] = p < k_max_category_folds ? hold_fold_out(problem, fold, p, seed)
                                            : hold_category_out(problem, p - k_max_category_folds);
    });
    std::vector<HeldOutShape> items;
    for (std::vector<HeldOutShape>& part : parts) std::ranges::move(part, std::back_inserter(items));
    return items;
}

/// Returns the weights of the items: known shapes and strangers have the same total, and in each group so do its
/// categories.
std::vector<double> item_weights(const std::vector<HeldOutShape>& items, std::size_t categories) {
    std::array<std::vector<double>, 2> count;
    for (auto& group : count) group.assign(categories, 0);
    for (const HeldOutShape& item : items) ++count[item.stranger ? 1 : 0][item.category];
    std::vector<double> weights;
    for (const HeldOutShape& item : items) {
        const std::vector<double>& group = count[item.stranger ? 1 : 0];
        const auto present = static_cast<double>(std::ranges::count_if(group, [](double n) { return n > 0; }));
        weights.push_back(1 / (present * group[item.category]));
    }
    return weights;
}

/// Fits the confidence: a logistic regression of being right on the evidence. The targets of Platt (1999) keep the
/// slope finite if the evidence separates the right answers from all others.
void fit_confidence(const std::vector<HeldOutShape>& items, const std::vector<double>& weights, CategoryModel& model) {
    const auto right = static_cast<double>(std::ranges::count_if(items, &HeldOutShape::right));
    const double yes = (right + 1) / (right + 2), no = 1 / (static_cast<double>(items.size()) - right + 2);
    std::vector<double> evidence, target, weight;
    for (std::size_t i = 0; i < items.size(); ++i) {
        evidence.push_back(items[i].evidence);
        target.push_back(items[i].right() ? yes : no);
        weight.push_back(weights[i] * (items[i].stranger ? k_stranger_share : 1 - k_stranger_share));
    }
    model.confidence = fit_rising_logistic(evidence, target, weight);
}

void fit_sharpness(const std::vector<HeldOutShape>& items, CategoryModel& model) {
    std::vector<float> scores, weights;
    std::vector<std::int32_t> labels;
    for (const HeldOutShape& item : items) {
        if (item.stranger) continue;
        for (const double score : item.scores) scores.push_back(k_score_unit * static_cast<float>(score));
        labels.push_back(static_cast<std::int32_t>(item.category));
        weights.push_back(1);
    }
    const std::array links{Link::softmax};
    const Calibration found = calibrate(scores, labels, weights, model.category_count(), links);
    model.sharpness = static_cast<double>(k_score_unit * found.scale);
}

CategoryReport report_of(const std::vector<HeldOutShape>& items, const std::vector<double>& weights,
                         const CategoryModel& model) {
    CategoryReport report;
    report.strangers_made_up = model.category_count() == 2;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const bool known = model.confidence.probability(items[i].evidence) >= model.min_confidence;
        if (items[i].stranger) {
            report.strangers_unknown += known ? 0 : weights[i];
            continue;
        }
        report.nearest_right += items[i].right() ? weights[i] : 0;
        report.right += items[i].right() && known ? weights[i] : 0;
        report.called_unknown += known ? 0 : weights[i];
    }
    return report;
}

void require_usable(const CategorizedShapes& training) {
    if (training.shapes.size() != training.category.size() || training.shapes.size() != training.provenance.size())
        throw UsageError("shapes, their categories and their origins differ in number");
    std::vector<std::size_t> counts(training.category_names.size(), 0);
    for (const std::int32_t category : training.category) {
        if (category < 0 || static_cast<std::size_t>(category) >= counts.size())
            throw UsageError(fmt::format("category {} of {}", category, counts.size()));
        ++counts[static_cast<std::size_t>(category)];
    }
    require_category_sizes(training.category_names, counts);
    const std::vector<std::string>& features = training.shapes.front().features;
    for (const ShapeDescriptor& shape : training.shapes)
        if (shape.features != features || shape.values.size() != k_shape_statistics * features.size())
            throw UsageError("shapes have different features; compute all with the same options");
    const Problem problem{&training};
    std::size_t most = 0;
    for (std::size_t c = 0; c < problem.categories(); ++c) most = std::max(most, distinct_shapes(problem, c).size());
    if (most < 2)
        throw UsageError(
            "each category has copies of one mesh only: nothing tells how alike meshes of a category are; give two "
            "different ones of one at least");
}

}  // namespace

void require_category_sizes(std::span<const std::string> names, std::span<const std::size_t> counts) {
    require_category_names(names);
    if (const auto none = std::ranges::find(counts, 0U); none != counts.end())
        throw UsageError(fmt::format("category {} has no meshes; give some or leave it out",
                                     mesh_io::quote(names[static_cast<std::size_t>(none - counts.begin())])));
    if (std::ranges::max(counts) < 2)
        throw UsageError(
            "each category has one mesh: nothing tells how alike meshes of a category are; give two of one at least");
}

void require_min_confidence(double min_confidence) {
    if (!(min_confidence >= 0 && min_confidence <= 1))
        throw UsageError(fmt::format("a least confidence of {}; give one from 0 to 1", min_confidence));
}

CategoryModel train_categories(const CategorizedShapes& training, const CategoryTrainingOptions& options,
                               CategoryReport& report) {
    require_usable(training);
    require_min_confidence(options.min_confidence);
    CategoryModel model;
    model.category_names = training.category_names;
    model.feature_options = training.feature_options;
    model.features = training.shapes.front().features;
    model.min_confidence = options.min_confidence;
    model.seed = options.seed;
    model.provenance = training.provenance;
    const Problem problem{&training};
    Indices all(training.shapes.size());
    std::iota(all.begin(), all.end(), 0);
    model.scores = fit(problem, all);
    const std::vector<HeldOutShape> items = hold_all_out(problem, options.seed);
    const std::vector<double> weights = item_weights(items, model.category_count());
    fit_confidence(items, weights, model);
    fit_sharpness(items, model);
    report = report_of(items, weights, model);
    return model;
}

}  // namespace exemplar
