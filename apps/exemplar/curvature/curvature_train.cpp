// exemplar curvature train: learns the map from poses to curvature of one animated surface.

#include <fmt/format.h>

#include "apps/exemplar/animation_arguments.h"
#include "apps/exemplar/arguments.h"
#include "apps/exemplar/common_options.h"
#include "apps/exemplar/curvature/curvature_options.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

struct CurvatureTrainOptions {
    CommonOptions common;
    std::filesystem::path animation, out;
    FrameArguments frames;
    CurvatureArguments curvature;
};

void run_curvature_train(const CurvatureTrainOptions& options) {
    const auto limits = apply_common_options(options.common);
    require_output_file(options.out);
    const Stopwatch watch;
    const Animation animation = animation_of_argument(options.animation, options.curvature.frames_per_second,
                                                      options.curvature.training.seed, options.common.quiet);
    const std::vector<FrameRef> frames = select_frames(animation, selection_of(options.frames));
    const CurvatureTraining training = training_of(options.curvature, animation.kind);
    CurvatureTrainingReport report;
    CurvatureModel model = train_curvature(animation, frames, training, report);
    model.training["animation"] = options.animation.filename().string();
    model.training["poses"] = std::to_string(frames.size());
    model.training["fps"] = fmt::format("{}", options.curvature.frames_per_second);
    for (const auto& [option, value] : training_words(training)) model.training[option] = value;
    save_curvature_model(options.out, model);

    fmt::print("{}, {} ({} varying), {}: {} with {}, {:.1f} of {:.1f} matter to a vertex\n", name_of(animation.kind),
               counted(report.vertices, "vertex", "vertices"), report.varying_vertices, counted(report.poses, "pose"),
               counted(report.controls, "control"), counted(report.inputs, "input"), report.kept_controls,
               report.possible_controls);
    fmt::print("{}, {:.2f} MB: {} in {} (curvature {}, influence {}, fit {})\n",
               counted(report.components, "component"),
               static_cast<double>(std::filesystem::file_size(options.out)) * 1e-6, options.out.string(),
               format_seconds(watch.wall()), format_seconds(report.seconds_truth),
               format_seconds(report.seconds_influence), format_seconds(report.seconds_fit));
    nlohmann::json json = describe_training(report);
    json["model"] = options.out.string();
    json["bytes"] = std::filesystem::file_size(options.out);
    json["seconds"]["all"] = watch.wall();
    json["seconds"]["cpu"] = watch.cpu();
    write_report(options.common, json);
}

}  // namespace

void add_curvature_train_command(Command& curvature) {
    auto options = std::make_shared<CurvatureTrainOptions>();
    Command* command = curvature.add_subcommand("train", "Learns curvature from the poses of an animation");
    command->footer(
        "Example:\n  exemplar curvature train figure.glb --clips walk,run --out figure.safetensors --seed 1");
    command->add_option("ANIM", options->animation, k_animation_argument)->required()->type_name("");
    command->add_option("--out", options->out, "model file to write, .safetensors")->required()->type_name("FILE");
    add_frame_options(*command, options->frames, "", "learn from");
    add_curvature_options(*command, options->curvature);
    add_common_options(*command, options->common);
    command->callback([options] { run_curvature_train(*options); });
}

}  // namespace exemplar
