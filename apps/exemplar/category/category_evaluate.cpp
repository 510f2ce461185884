// exemplar category evaluate: how often shapes that were not trained on get their category, and strangers none.

#include <fmt/format.h>

#include <numeric>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/category/category_shapes.h"
#include "apps/exemplar/category/category_trials.h"
#include "apps/exemplar/commands.h"
#include "host/core/interrupt.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/labeling/category/category_evaluation.h"
#include "host/labeling/features/feature_cache.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct CategoryEvaluateCommand {
    CommonOptions common;
    CategoryTrialOptions trials;
    fs::path cache = default_feature_folder();
    FeatureOptions features;
    CategoryTrainingOptions training;
};

/// Shapes of all splits by what they were called.
struct Counts {
    std::size_t categories;
    std::vector<std::size_t> confusion;                     ///< categories x (categories + 1)
    std::vector<std::size_t> strangers, strangers_unknown;  ///< per category
    std::size_t shapes = 0, right = 0, unknown = 0, nearest = 0;
};

void add(const CategorizedShapes& all, const CategoryTest& test, Counts& counts) {
    const std::vector<std::size_t> confusion = category_confusion(all, test.shapes);
    for (std::size_t i = 0; i < confusion.size(); ++i) counts.confusion[i] += confusion[i];
    for (const RecognizedShape& shape : test.shapes) {
        ++counts.shapes;
        counts.right += shape.called == all.category[shape.shape];
        counts.nearest += shape.nearest == all.category[shape.shape];
        counts.unknown += shape.called < 0;
    }
    for (const RecognizedShape& shape : test.strangers) {
        const auto category = static_cast<std::size_t>(all.category[shape.shape]);
        ++counts.strangers[category];
        counts.strangers_unknown[category] += shape.called < 0;
    }
}

double share(std::size_t part, std::size_t whole) {
    return whole ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

void print_counts(const CategorizedShapes& all, const Counts& counts) {
    const std::size_t columns = counts.categories + 1;
    fmt::print("{:>12}", "called:");
    for (const std::string& name : all.category_names) fmt::print(" {:>8.8}", name);
    fmt::print(" {:>8} {:>10}\n", "unknown", "not learned");
    for (std::size_t t = 0; t < counts.categories; ++t) {
        fmt::print("{:>12.12}", all.category_names[t]);
        for (std::size_t p = 0; p < columns; ++p) {
            const std::size_t count = counts.confusion[t * columns + p];
            fmt::print(" {:>8}", count ? fmt::to_string(count) : ".");
        }
        fmt::print(" {:>10}\n", counts.strangers[t] ? fmt::format("{:.1f} %", 100 * share(counts.strangers_unknown[t],
                                                                                          counts.strangers[t]))
                                                    : "-");
    }
    const std::size_t strangers = std::accumulate(counts.strangers.begin(), counts.strangers.end(), std::size_t{0});
    const std::size_t unknown =
        std::accumulate(counts.strangers_unknown.begin(), counts.strangers_unknown.end(), std::size_t{0});
    fmt::print("{} tested: {:.1f} % right, {:.1f} % wrong, {:.1f} % called unknown; nearest category right {:.1f} %\n",
               counted(counts.shapes, "shape"), 100 * share(counts.right, counts.shapes),
               100 * share(counts.shapes - counts.right - counts.unknown, counts.shapes),
               100 * share(counts.unknown, counts.shapes), 100 * share(counts.nearest, counts.shapes));
    if (strangers)
        fmt::print("with their category not learned: {:.1f} % called unknown\n", 100 * share(unknown, strangers));
}

/// A category's name; null for unknown.
nlohmann::json name_of(const CategorizedShapes& all, std::int32_t category) {
    return category < 0 ? nlohmann::json(nullptr)
                        : nlohmann::json(all.category_names[static_cast<std::size_t>(category)]);
}

nlohmann::json describe_shapes(const CategorizedShapes& all, const std::vector<fs::path>& paths,
                               const std::vector<RecognizedShape>& shapes) {
    nlohmann::json json = nlohmann::json::array();
    for (const RecognizedShape& shape : shapes)
        json.push_back({{"mesh", paths[shape.shape].string()},
                        {"category", name_of(all, all.category[shape.shape])},
                        {"called", name_of(all, shape.called)},
                        {"nearest", name_of(all, shape.nearest)},
                        {"confidence", shape.confidence}});
    return json;
}

nlohmann::json describe_test(const CategorizedShapes& all, const std::vector<fs::path>& paths, const Split& split,
                             const CategoryTest& test) {
    nlohmann::json train = nlohmann::json::array();
    for (const std::size_t i : split.train) train.push_back(paths[i].string());
    return {{"train", std::move(train)},
            {"held_out", describe_category_report(test.training)},
            {"meshes", describe_shapes(all, paths, test.shapes)},
            {"not_learned", describe_shapes(all, paths, test.strangers)}};
}

nlohmann::json describe_counts(const CategorizedShapes& all, const Counts& counts) {
    nlohmann::json rows = nlohmann::json::array(), strangers;
    for (std::size_t t = 0; t < counts.categories; ++t) {
        const auto row = counts.confusion.begin() + static_cast<std::ptrdiff_t>(t * (counts.categories + 1));
        rows.push_back(std::vector<std::size_t>(row, row + static_cast<std::ptrdiff_t>(counts.categories + 1)));
        if (counts.strangers[t])
            strangers[all.category_names[t]] = share(counts.strangers_unknown[t], counts.strangers[t]);
    }
    return {{"categories", all.category_names},
            {"confusion", std::move(rows)},
            {"shapes", counts.shapes},
            {"right", share(counts.right, counts.shapes)},
            {"called_unknown", share(counts.unknown, counts.shapes)},
            {"nearest_right", share(counts.nearest, counts.shapes)},
            {"not_learned_unknown", std::move(strangers)}};
}

void run_category_evaluate(const CategoryEvaluateCommand& options) {
    const auto limits = apply_common_options(options.common);
    const Stopwatch watch;
    require_min_confidence(options.training.min_confidence);
    const CategoryTrials trials = make_category_trials(options.trials, options.training.seed);
    if (!options.common.quiet)
        for (const std::string& remark : trials.remarks) fmt::print(stderr, "warning: {}\n", remark);
    const std::vector<fs::path> paths = trials.paths();
    const fs::path cache = usable_cache(options.cache, options.common.quiet);
    const CategorizedShapes all = describe_categories(trials.categories, options.features, cache, options.common.quiet);
    const std::size_t categories = all.category_names.size();
    Counts counts{categories, std::vector<std::size_t>(categories * (categories + 1), 0),
                  std::vector<std::size_t>(categories, 0), std::vector<std::size_t>(categories, 0)};
    nlohmann::json tests = nlohmann::json::array();
    for (std::size_t k = 0; k < trials.splits.size(); ++k) {
        check_interrupt();
        const CategoryTest test = test_categories(all, trials.splits[k], options.training);
        add(all, test, counts);
        tests.push_back(describe_test(all, paths, trials.splits[k], test));
    }
    print_counts(all, counts);
    nlohmann::json json = describe_counts(all, counts);
    json["splits"] = std::move(tests);
    json["least_confidence"] = options.training.min_confidence;
    json["remarks"] = trials.remarks;
    json["seconds"] = {{"all", watch.wall()}, {"cpu", watch.cpu()}};
    write_report(options.common, json);
}

}  // namespace

void add_category_evaluate_command(Command& category) {
    auto options = std::make_shared<CategoryEvaluateCommand>();
    Command* command = category.add_subcommand("evaluate", "Trains on some meshes of each category and tests others");
    command->footer(
        "The last column of the table: how often shapes of a category are called unknown by a model that was trained\n"
        "without that category.\n\nExamples:\n"
        "  exemplar category evaluate psb/labeled --train-count 6 --splits 3\n"
        "  exemplar category evaluate --train cup=a.txt human=b.txt ant=c.txt --test cup=d.txt human=e.txt ant=f.txt");
    Option* sources = command->add_option("SOURCE", options->trials.sources, k_category_source_help)->type_name("");
    Option* train =
        command->add_option("--train", options->trials.train, "training meshes, as SOURCE")->type_name("SOURCE");
    Option* test = command->add_option("--test", options->trials.test, "test meshes, as SOURCE")->type_name("SOURCE");
    Option* count =
        command->add_option("--train-count", options->trials.train_count, "meshes of each category to learn from")
            ->capture_default_str()
            ->check(whole_number(2, 1'000'000));
    Option* splits = command->add_option("--splits", options->trials.splits, "random splits, each a training")
                         ->capture_default_str()
                         ->check(whole_number(1, 1000));
    for (Option* option : {train, test}) option->excludes(sources)->excludes(count)->excludes(splits);
    add_category_options(*command, options->training, options->features, options->cache);
    add_common_options(*command, options->common);
    command->callback([options] { run_category_evaluate(*options); });
}

}  // namespace exemplar
