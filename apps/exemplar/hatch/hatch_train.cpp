// exemplar hatch train: a style from drawings by one hand.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/hatch/hatch_reading.h"
#include "apps/exemplar/hatch/hatch_scene.h"
#include "host/core/errors.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/hatching/style/style_learning.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// A drawing, and the scene that it shows.
struct DrawingArguments {
    HatchSceneArguments scene;
    fs::path drawing, mask;
    std::size_t page = 0;
};

struct TrainArguments {
    DrawingArguments first;
    std::vector<std::string> also;    // of each further drawing: mesh, view file and drawing
    std::vector<std::string> masks;   // of the drawings, in their order
    std::vector<std::string> labels;  // of the meshes, in their order
    std::vector<std::size_t> pages;   // of the drawings, in their order
    fs::path out;
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

/// Returns all drawings with their masks; checks what can be checked before any work.
std::vector<DrawingArguments> require_drawings(const TrainArguments& arguments) {
    std::vector<DrawingArguments> drawings{arguments.first};
    if (arguments.also.size() % 3 != 0)
        throw UsageError("--also takes three files a drawing: the mesh, the view that was drawn, and the drawing");
    for (std::size_t i = 0; i < arguments.also.size(); i += 3) {
        DrawingArguments& more = drawings.emplace_back();
        more.scene.mesh = arguments.also[i];
        more.scene.view_file = arguments.also[i + 1];
        more.scene.cache = arguments.first.scene.cache;
        more.drawing = arguments.also[i + 2];
    }
    if (arguments.masks.size() > drawings.size())
        throw UsageError(fmt::format("{} masks are given, but {} drawing{}", arguments.masks.size(), drawings.size(),
                                     drawings.size() == 1 ? "" : "s"));
    for (std::size_t i = 0; i < arguments.masks.size(); ++i) drawings[i].mask = arguments.masks[i];
    if (!arguments.labels.empty() && arguments.labels.size() != drawings.size())
        throw UsageError(
            fmt::format("--labels names {}, but there {} drawn: give labels for each, in their order",
                        counted(arguments.labels.size(), "file"),
                        drawings.size() == 1 ? "is 1 mesh" : fmt::format("are {} meshes", drawings.size())));
    for (std::size_t i = 0; i < arguments.labels.size(); ++i) drawings[i].scene.labels = arguments.labels[i];
    if (arguments.pages.size() > drawings.size())
        throw UsageError(fmt::format("--page is given {} times, for {}", arguments.pages.size(),
                                     counted(drawings.size(), "drawing")));
    for (std::size_t i = 0; i < drawings.size(); ++i) drawings[i].page = page_of(arguments.pages, i);
    for (DrawingArguments& each : drawings) {
        require_hatch_scene(each.scene);
        require_input(each.drawing);
        if (!each.mask.empty()) require_input(each.mask);
        require_not_replaced(arguments.out, {each.scene.mesh, each.drawing, each.mask});
    }
    return drawings;
}

/// A drawing that was read.
struct ReadDrawing {
    std::unique_ptr<HatchScene> scene;
    DrawingProperties properties;
};

ReadDrawing read_drawing_of(const DrawingArguments& arguments, const CommonOptions& common,
                            LearningProgress& progress) {
    progress.begins("surface");
    ReadDrawing out{std::make_unique<HatchScene>(arguments.scene, common.device, common.quiet), {}};
    progress.begins("reading the drawing");
    PixelFeatures& pixels = out.scene->pixels();
    out.properties = drawing_properties(
        read_drawing({arguments.drawing, arguments.page}, arguments.scene, pixels, common.quiet).strokes);
    if (!arguments.mask.empty()) restrict_to(read_mask(arguments.mask, pixels), out.properties);
    return out;
}

std::string names_of(std::span<const DrawingArguments> drawings) {
    std::string names;
    for (const DrawingArguments& each : drawings)
        names += (names.empty() ? "" : ", ") + each.drawing.filename().string();
    return names;
}

void run_hatch_train(TrainArguments& arguments) {
    const auto limits = apply_common_options(arguments.common);
    require_output_file(arguments.out);
    const std::vector<DrawingArguments> drawings = require_drawings(arguments);
    Stopwatch watch;
    LearningProgress progress;
    std::vector<ReadDrawing> read;
    read.reserve(drawings.size());
    for (const DrawingArguments& each : drawings) read.push_back(read_drawing_of(each, arguments.common, progress));
    std::vector<HatchingExample> examples;
    examples.reserve(read.size());
    for (const ReadDrawing& each : read) examples.push_back({each.scene->pixels(), each.properties});
    const double reading = watch.wall();
    progress.begins("orientation rules");
    StyleReport report;
    HatchingStyle style = learn_hatching_style(examples, read.front().scene->tools().scorer, arguments.learning, report,
                                               [&](const char* step) { progress.begins(step); });
    progress.finish();
    style.name = names_of(drawings);
    save_hatching_style(arguments.out, style);
    if (!arguments.common.quiet) fmt::print("{}{}\n", describe_hatching_style(style), arguments.out.string());
    write_report(arguments.common, describe_style(report, style, reading));
}

}  // namespace

void add_hatch_train_command(Command& hatch) {
    auto arguments = std::make_shared<TrainArguments>();
    Command* command =
        hatch.add_subcommand("train", "Learns a style from a drawing of a view, or several by the same hand");
    command->footer(
        "Examples:\n  exemplar hatch train bunny.off traced.png --template bunny.png --out mine.safetensors\n  "
        "exemplar "
        "hatch train bunny.off traced.png --template bunny.png --also cow.off cow.png cow_drawn.png --out "
        "mine.safetensors");
    DrawingArguments& first = arguments->first;
    command->add_option("MESH", first.scene.mesh, "mesh that the drawing shows")->required()->type_name("");
    command->add_option("DRAWING", first.drawing, "the drawing (PNG, JPEG, TIFF or SVG)")->required()->type_name("");
    command
        ->add_option("--also", arguments->also,
                     "another drawing by the same hand: its mesh, the view that it was made for (as --template), and "
                     "the drawing")
        ->type_name("MESH VIEW DRAWING");
    command
        ->add_option("--mask", arguments->masks,
                     "picture of the view, white where to learn from the drawing (PNG, JPEG or TIFF): black hides a "
                     "signature, a "
                     "shadow, a slip of the pen; with --also, one for each drawing in order")
        ->type_name("FILE");
    command
        ->add_option("--labels", arguments->labels,
                     "labels of the mesh's faces (_labels.txt, .seg or labeled PLY): hatching may differ from part to "
                     "part, and drawing then needs labels, too; with --also, one for each drawing in order")
        ->type_name("FILE");
    add_page_option(*command, arguments->pages, "with --also");
    command->add_option("--out", arguments->out, "style file to write")->required()->type_name("FILE");
    command->add_option("--seed", arguments->learning.seed, "of all random choices")
        ->capture_default_str()
        ->check(whole_number(0));
    add_template_option(*command, first.scene, add_hatch_scene_options(*command, first.scene));
    add_device_option(*command, arguments->common);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_hatch_train(*arguments); });
}

}  // namespace exemplar
