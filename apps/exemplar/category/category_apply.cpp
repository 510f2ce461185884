// exemplar category apply: says of each mesh what category it is of.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/category/category_shapes.h"
#include "apps/exemplar/commands.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/data/corpus.h"
#include "host/labeling/category/category_training.h"
#include "host/labeling/category/descriptor_cache.h"
#include "host/labeling/features/feature_cache.h"

namespace exemplar {
namespace {

struct CategoryApplyCommand {
    CommonOptions common;
    std::filesystem::path model;
    std::filesystem::path cache = default_feature_folder();
    std::vector<std::filesystem::path> meshes;
    std::optional<double> min_confidence;
};

/// The two most probable categories.
std::array<std::size_t, 2> two_most_probable(const std::vector<float>& probability) {
    std::vector<std::size_t> order(probability.size());
    for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return probability[a] > probability[b]; });
    return {order[0], order[1]};
}

/// Prints the line of a mesh and returns its part of the report.
nlohmann::json recognize_mesh(const std::filesystem::path& path, const CategoryModel& model,
                              const std::filesystem::path& cache, bool quiet) {
    const MeshFile file = read_mesh(path);
    const std::vector<std::string> warnings = mesh_warnings(file, path, quiet);
    const CategoryPrediction prediction = of_file(
        path, [&] { return recognize(model, cached_shape_descriptor(file.mesh, model.feature_options, cache)); });
    const auto [best, second] = two_most_probable(prediction.probability);
    const bool known = prediction.category >= 0;
    const std::string name = known ? model.category_names[best] : std::string(k_unknown_category);
    fmt::print("{:<24} {:<14} confidence {:.2f}  {} {:.2f}, {} {:.2f}\n", path.filename().string(), name,
               prediction.confidence, model.category_names[best], prediction.probability[best],
               model.category_names[second], prediction.probability[second]);
    nlohmann::json probabilities;
    for (std::size_t c = 0; c < model.category_count(); ++c)
        probabilities[model.category_names[c]] = prediction.probability[c];
    return {{"mesh", path.string()},
            {"category", known ? nlohmann::json(name) : nlohmann::json(nullptr)},
            {"confidence", prediction.confidence},
            {"nearest", model.category_names[best]},
            {"runner_up", model.category_names[second]},
            {"probabilities", std::move(probabilities)},
            {"warnings", warnings}};
}

void run_category_apply(const CategoryApplyCommand& options) {
    const auto limits = apply_common_options(options.common);
    require_input(options.model);
    if (std::filesystem::is_directory(options.model))
        throw ModelError(fmt::format("{}: is a folder; give the model file before the meshes", options.model.string()));
    CategoryModel model = load_category_model(options.model);
    if (options.min_confidence) {
        require_min_confidence(*options.min_confidence);
        model.min_confidence = *options.min_confidence;
    }
    const std::vector<std::filesystem::path> meshes = meshes_of_arguments(options.meshes);
    const std::filesystem::path cache = usable_cache(options.cache, options.common.quiet);

    Progress progress("recognizing", meshes.size());
    nlohmann::json results = nlohmann::json::array();
    std::vector<std::string> failures;
    for (const auto& path : meshes) {
        check_interrupt();
        try {
            results.push_back(recognize_mesh(path, model, cache, options.common.quiet));
        } catch (const MeshError& error) {  // one bad mesh is no reason to say nothing of the others
            failures.emplace_back(error.what());
            results.push_back({{"mesh", path.string()}, {"error", error.what()}});
        }
        progress.advance(1, path.filename().string());
    }
    progress.finish();
    write_report(options.common, {{"model", options.model.string()},
                                  {"categories", model.category_names},
                                  {"least_confidence", model.min_confidence},
                                  {"meshes", results}});
    if (meshes.size() == 1 && !failures.empty()) throw MeshError(failures.front());
    for (const std::string& failure : failures) fmt::print(stderr, "error: {}\n", failure);
    if (!failures.empty())
        throw MeshError(fmt::format("{} of {} meshes could not be recognized", failures.size(), meshes.size()));
}

}  // namespace

void add_category_apply_command(Command& category) {
    auto options = std::make_shared<CategoryApplyCommand>();
    Command* command = category.add_subcommand("apply", "Says of each mesh what category it is of, or 'unknown'");
    command->footer(
        "Prints a line a mesh: its category, how sure that is, and the two most probable categories.\n\nExample:\n"
        "  exemplar category apply categories.safetensors a.off b.obj --json report.json");
    command->add_option("MODEL", options->model, "model file of 'exemplar category train'")->required()->type_name("");
    command->add_option("MESH", options->meshes, "meshes, folders of meshes, or lists (.txt, a path a line)")
        ->required()
        ->type_name("");
    command
        ->add_option("--least-confidence", options->min_confidence,
                     "a shape of less is called unknown, from 0 (never) to 1; without it as the model was trained")
        ->check(in_range(0.0, 1.0))
        ->type_name("SHARE");
    command->add_option("--cache", options->cache, "folder that remembers what shapes are like; '' remembers nothing")
        ->capture_default_str()
        ->type_name("FOLDER");
    add_common_options(*command, options->common);
    command->callback([options] { run_category_apply(*options); });
}

}  // namespace exemplar
