// exemplar hatch example: a drawing by a known rule.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/common_options.h"
#include "apps/exemplar/hatch/hatch_scene.h"
#include "apps/help/command.h"
#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/hatching/fields/ink.h"
#include "host/imaging/png.h"
#include "host/synth/hatching/hatched_drawing.h"

namespace exemplar {
namespace {

struct ExampleArguments {
    std::string style;
    HatchSceneArguments scene;
    CommonOptions common;
    std::filesystem::path out;
    std::uint64_t seed = 1;
};

void run_example(ExampleArguments& arguments) {
    const auto limits = apply_common_options(arguments.common);
    if (std::ranges::find(hatching_rule_names(), arguments.style) == hatching_rule_names().end())
        throw UsageError(fmt::format("STYLE '{}' is not built in; there are {}", arguments.style,
                                     fmt::join(hatching_rule_names(), ", ")));
    require_hatch_scene(arguments.scene);
    require_output_picture(arguments.out);
    require_not_replaced(arguments.out, {arguments.scene.mesh});
    HatchScene scene(arguments.scene, arguments.common.device, arguments.common.quiet);
    const RuledDrawing drawing = draw_by_rule(arguments.style, scene.pixels(), scene.tools().placer, arguments.seed);
    write_png(arguments.out, ink_picture(drawing.ink, drawing.truth.width, drawing.truth.height));
    if (!arguments.common.quiet)
        fmt::print("{}: {}\n", arguments.out.string(), counted(drawing.strokes.size(), "stroke"));
    write_report(arguments.common, {{"style", arguments.style}, {"strokes", drawing.strokes.size()}});
}

}  // namespace

void add_hatch_example_command(Command& hatch) {
    auto arguments = std::make_shared<ExampleArguments>();
    Command* command = hatch.add_subcommand("example", "Draws a view in one of the styles that are built in");
    command->footer(
        fmt::format("Styles: {}\n\nExample:\n"
                    "  exemplar hatch example contour bunny.off --out drawing.png",
                    fmt::join(hatching_rule_names(), " ")));
    command->add_option("STYLE", arguments->style, "how it is drawn")
        ->required()
        ->check(completion_words(hatching_rule_names()))
        ->type_name("");
    command->add_option("MESH", arguments->scene.mesh, k_mesh_argument)->required()->type_name("");
    command->add_option("--out", arguments->out, "the drawing to write (PNG)")->required()->type_name("FILE");
    command->add_option("--seed", arguments->seed, "of the hand's jitter")
        ->capture_default_str()
        ->check(whole_number(0));
    add_template_option(*command, arguments->scene, add_hatch_scene_options(*command, arguments->scene));
    add_device_option(*command, arguments->common);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_example(*arguments); });
}

}  // namespace exemplar
