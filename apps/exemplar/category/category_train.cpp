// exemplar category train: learns to recognize categories from folders of meshes.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/category/category_shapes.h"
#include "apps/exemplar/commands.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/labeling/features/feature_cache.h"

namespace exemplar {
namespace {

struct CategoryTrainCommand {
    CommonOptions common;
    std::vector<std::string> sources;
    std::filesystem::path out;
    std::filesystem::path cache = default_feature_folder();
    FeatureOptions features;
    CategoryTrainingOptions training;
};

nlohmann::json describe_training(const CategoryTrainCommand& options, const std::vector<CategoryMeshes>& categories,
                                 const CategoryModel& model, const CategoryReport& report) {
    nlohmann::json listed = nlohmann::json::array();
    for (const CategoryMeshes& category : categories)
        listed.push_back({{"category", category.name}, {"meshes", category.meshes.size()}});
    return {{"model", options.out.string()},
            {"categories", std::move(listed)},
            {"training_meshes", model.provenance},
            {"held_out", describe_category_report(report)},
            {"least_confidence", model.min_confidence}};
}

/// Throws before the long work if the categories cannot be learned.
void require_learnable(const std::vector<CategoryMeshes>& categories) {
    std::vector<std::string> names;
    std::vector<std::size_t> counts;
    for (const CategoryMeshes& category : categories) {
        names.push_back(category.name);
        counts.push_back(category.meshes.size());
    }
    require_category_sizes(names, counts);
}

void run_category_train(const CategoryTrainCommand& options) {
    const auto limits = apply_common_options(options.common);
    const Stopwatch watch;
    require_output_file(options.out);
    require_min_confidence(options.training.min_confidence);
    const std::vector<CategoryMeshes> categories = categories_of_arguments(options.sources);
    require_learnable(categories);
    for (const CategoryMeshes& category : categories) require_not_replaced(options.out, category.meshes);
    const std::filesystem::path cache = usable_cache(options.cache, options.common.quiet);
    const CategorizedShapes shapes = describe_categories(categories, options.features, cache, options.common.quiet);
    const double describe_seconds = watch.wall();
    CategoryReport report;
    const CategoryModel model = train_categories(shapes, options.training, report);
    save_category_model(options.out, model);

    for (const CategoryMeshes& category : categories)
        fmt::print("{:>16} {}\n", category.name, counted(category.meshes.size(), "mesh", "meshes"));
    print_category_report(report);
    fmt::print("{} of {}: {} in {:.1f} s (features {:.1f} s)\n", counted(categories.size(), "category", "categories"),
               counted(shapes.shapes.size(), "mesh", "meshes"), options.out.string(), watch.wall(), describe_seconds);
    nlohmann::json json = describe_training(options, categories, model, report);
    json["seconds"] = {{"features", describe_seconds}, {"all", watch.wall()}, {"cpu", watch.cpu()}};
    write_report(options.common, json);
}

}  // namespace

void add_category_train_command(Command& category) {
    auto options = std::make_shared<CategoryTrainCommand>();
    Command* command = category.add_subcommand("train", "Learns categories from meshes of each");
    command->footer(
        "Needs meshes of two categories at least, and of one of them two; six of each are a good start.\n"
        "To choose among models for 'label batch --models', give --samples as to 'label "
        "train'.\n\nExamples:\n"
        "  exemplar category train psb/labeled --out categories.safetensors\n"
        "  exemplar category train shapes/cup human=people.txt --out categories.safetensors --seed 1");
    command->add_option("SOURCE", options->sources, k_category_source_help)->required()->type_name("");
    command->add_option("--out", options->out, "model file to write, .safetensors")->required()->type_name("FILE");
    add_category_options(*command, options->training, options->features, options->cache);
    add_common_options(*command, options->common);
    command->callback([options] { run_category_train(*options); });
}

}  // namespace exemplar
