// exemplar curvature evaluate: compares a model with measured curvature on unseen frames.

#include <fmt/format.h>

#include <set>

#include "apps/exemplar/animation_arguments.h"
#include "apps/exemplar/arguments.h"
#include "apps/exemplar/common_options.h"
#include "apps/exemplar/curvature/curvature_options.h"
#include "apps/exemplar/curvature/curvature_pictures.h"
#include "host/core/stopwatch.h"

namespace exemplar {
namespace {

struct EvaluateOptions {
    CommonOptions common;
    std::filesystem::path model, animation, pictures;
    FrameArguments frames;
    double frames_per_second = 30;
    std::uint64_t seed = 2;
};

/// Writes pictures of the first, the middle and the last frame.
void write_frame_pictures(const std::filesystem::path& folder, const CurvatureModel& model, const Animation& animation,
                          const std::vector<FrameRef>& frames) {
    std::filesystem::create_directories(folder);
    for (const std::size_t i : std::set<std::size_t>{0, frames.size() / 2, frames.size() - 1})
        write_line_pictures(folder, model, animation, frames[i]);
}

void run_curvature_evaluate(const EvaluateOptions& options) {
    const auto limits = apply_common_options(options.common);
    const Stopwatch watch;
    require_input(options.model);
    const CurvatureModel model = load_curvature_model(options.model);
    const Animation animation =
        animation_of_argument(options.animation, options.frames_per_second, options.seed, options.common.quiet);
    const std::vector<FrameRef> frames = select_frames(animation, selection_of(options.frames));
    const CurvatureEvaluation evaluation = evaluate_curvature(model, animation, frames);
    print_evaluation(evaluation);
    if (!options.pictures.empty()) write_frame_pictures(options.pictures, model, animation, frames);
    nlohmann::json json = describe_evaluation(evaluation);
    json["model"] = options.model.string();
    json["animation"] = options.animation.string();
    json["bytes"] = std::filesystem::file_size(options.model);
    json["seconds"] = watch.wall();
    write_report(options.common, json);
}

}  // namespace

void add_curvature_evaluate_command(Command& curvature) {
    auto options = std::make_shared<EvaluateOptions>();
    Command* command =
        curvature.add_subcommand("evaluate", "Compares learned with measured curvature, on unseen frames");
    command->footer(
        "Misclassified are faces that carry a line by one curvature but not by the other, seen from six sides. Zero\n"
        "order is the mean curvature of training in place of the learned.\n\nExample:\n"
        "  exemplar curvature evaluate figure.safetensors figure.glb --frames 100: --json errors.json");
    command->add_option("MODEL", options->model, "model file of 'exemplar curvature train'")->required()->type_name("");
    command->add_option("ANIM", options->animation, "animation of the same surface")->required()->type_name("");
    add_frame_options(*command, options->frames, "", "compare");
    command
        ->add_option("--pictures", options->pictures,
                     "folder for pictures of three frames: lines by measured, learned and zero-order curvature")
        ->type_name("DIR");
    command->add_option("--fps", options->frames_per_second, k_fps_option)
        ->capture_default_str()
        ->check(in_range(0.1, 1000.0));
    command->add_option("--seed", options->seed, "seed of random expressions, for blend shapes without a clip")
        ->capture_default_str()
        ->check(whole_number(0));
    add_common_options(*command, options->common);
    command->callback([options] { run_curvature_evaluate(*options); });
}

}  // namespace exemplar
