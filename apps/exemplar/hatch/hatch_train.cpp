// exemplar hatch train: a style from one drawing.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/hatch/hatch_reading.h"
#include "apps/exemplar/hatch/hatch_scene.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/hatching/style/style_learning.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct TrainArguments {
    HatchSceneArguments scene;
    fs::path drawing, mask, out;
    StyleLearningOptions learning;
    CommonOptions common;
};

/// Steps of learning in order, and the percentage of time that each takes for a typical drawing.
struct LearningStep {
    std::string_view name;
    std::size_t share;
};
constexpr std::array<LearningStep, 12> k_learning_steps{{{"surface", 13},
                                                         {"reading the drawing", 30},
                                                         {"orientation rules", 25},
                                                         {"segments", 14},
                                                         {"boundaries", 2},
                                                         {"label cuts", 1},
                                                         {"corrections", 7},
                                                         {"hatching levels", 2},
                                                         {"thickness", 1},
                                                         {"intensity", 1},
                                                         {"spacing", 2},
                                                         {"length", 2}}};

/// Shows the progress of learning. Skips steps that a drawing does not need.
class LearningProgress {
  public:
    /// All steps before this one are done.
    void begins(std::string_view step) {
        const auto at = std::ranges::find(k_learning_steps, step, &LearningStep::name);
        progress_.advance(at == k_learning_steps.end() ? 0 : passed_before(at), std::string(step));
    }
    void finish() {
        progress_.advance(passed_before(k_learning_steps.end()));
        progress_.finish();
    }

  private:
    using Step = decltype(k_learning_steps)::const_iterator;
    std::size_t passed_before(Step next) {
        std::size_t share = 0;
        for (; current_ < next; ++current_) share += current_->share;
        return share;
    }

    Step current_ = k_learning_steps.begin();
    Progress progress_{"learning", 100};
};

nlohmann::json describe_style(const StyleReport& report, const HatchingStyle& style, double reading) {
    nlohmann::json seconds = {{"reading", reading}};
    for (const auto& [step, time] : report.seconds) seconds[step] = time;
    return {{"segments", style.rules.size()},
            {"orientation_error", report.orientation_error},
            {"direction_errors", report.direction_errors},
            {"segment_errors", report.segment_errors},
            {"boundary_error", report.boundary_error},
            {"level_error", report.level_error},
            {"property_errors", report.property},
            {"seconds", seconds}};
}

void run_hatch_train(TrainArguments& arguments) {
    const auto limits = apply_common_options(arguments.common);
    require_hatch_scene(arguments.scene);
    require_input(arguments.drawing);
    if (!arguments.mask.empty()) require_input(arguments.mask);
    require_output_file(arguments.out);
    require_not_replaced(arguments.out, {arguments.scene.mesh, arguments.drawing, arguments.mask});
    Stopwatch watch;
    LearningProgress progress;
    HatchScene scene(arguments.scene, arguments.common.device, arguments.common.quiet);
    progress.begins("reading the drawing");
    const AlignedDrawing drawing =
        read_drawing(arguments.drawing, arguments.scene, scene.pixels(), arguments.common.quiet);
    DrawingProperties properties = drawing_properties(drawing.strokes);
    if (!arguments.mask.empty()) restrict_to(read_mask(arguments.mask, scene.pixels()), properties);
    const double reading = watch.wall();
    progress.begins("orientation rules");
    StyleReport report;
    HatchingStyle style = learn_hatching_style(scene.pixels(), properties, scene.tools().scorer, arguments.learning,
                                               report, [&](const char* step) { progress.begins(step); });
    progress.finish();
    style.name = arguments.drawing.filename().string();
    save_hatching_style(arguments.out, style);
    if (!arguments.common.quiet) fmt::print("{}{}\n", describe_hatching_style(style), arguments.out.string());
    write_report(arguments.common, describe_style(report, style, reading));
}

}  // namespace

void add_hatch_train_command(Command& hatch) {
    auto arguments = std::make_shared<TrainArguments>();
    Command* command = hatch.add_subcommand("train", "Learns a style from one drawing of a view");
    command->footer(
        "Example:\n  exemplar hatch train bunny.off traced.png --template bunny.png --out mine.safetensors");
    command->add_option("MESH", arguments->scene.mesh, "mesh that the drawing shows")->required()->type_name("");
    command->add_option("DRAWING", arguments->drawing, "the drawing (PNG or JPEG)")->required()->type_name("");
    command
        ->add_option("--mask", arguments->mask,
                     "picture of the view, white where to learn from the drawing (PNG): black hides a signature, a "
                     "shadow, a slip of the pen")
        ->type_name("FILE");
    command->add_option("--out", arguments->out, "style file to write")->required()->type_name("FILE");
    command->add_option("--seed", arguments->learning.seed, "of all random choices")
        ->capture_default_str()
        ->check(whole_number(0));
    add_template_option(*command, arguments->scene, add_hatch_scene_options(*command, arguments->scene));
    add_device_option(*command, arguments->common);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_hatch_train(*arguments); });
}

}  // namespace exemplar
