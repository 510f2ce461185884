// exemplar label prototype glasses: glasses to print, and their lenses to cut.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ostream>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/parts/labeled_input.h"
#include "apps/exemplar/parts/solid_output.h"
#include "host/core/files.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/parts/prototype/glasses.h"

namespace exemplar {
namespace {

struct GlassesCommand {
    CommonOptions common;
    LabeledInputArguments input;
    std::filesystem::path out;
    GlassesOptions glasses;
};

std::vector<float> numbers_of(const Vec3& p) {
    return {p[0], p[1], p[2]};
}

/// Writes the outline of a lens as SVG in millimeters.
void write_outline(const std::filesystem::path& path, const GlassesLens& lens) {
    Vec2 high = Vec2::Zero();
    for (const std::vector<Vec2>& loop : lens.outline)
        for (const Vec2& p : loop) high = high.cwiseMax(p.cwiseAbs());
    std::string data;
    for (const std::vector<Vec2>& loop : lens.outline) {
        for (std::size_t i = 0; i < loop.size(); ++i)
            data += fmt::format("{}{:.3f} {:.3f}", i == 0 ? "M" : "L", loop[i].x(), -loop[i].y());
        data += "Z";
    }
    write_file_atomically(path, [&](std::ostream& out) {
        out << fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.3f}mm\" height=\"{1:.3f}mm\" viewBox=\"{2:.3f} "
            "{3:.3f} {0:.3f} {1:.3f}\"><path d=\"{4}\" fill=\"none\" stroke=\"#ff0000\" stroke-width=\"0.1\"/></svg>\n",
            2 * high.x() + 2, 2 * high.y() + 2, -high.x() - 1, -high.y() - 1, data);
    });
}

nlohmann::json describe_arms(const Glasses& glasses) {
    nlohmann::json arms = nlohmann::json::array();
    for (const GlassesArm& arm : glasses.arms)
        arms.push_back({{"arm", arm.name},
                        {"center", numbers_of(arm.hinge.center)},
                        {"back", numbers_of(arm.hinge.back)},
                        {"inward", numbers_of(arm.hinge.inward)},
                        {"radius", arm.hinge.radius},
                        {"pin_radius", arm.hinge.pin_radius},
                        {"height", arm.hinge.height},
                        {"spread", arm.spread},
                        {"turns", arm.turns},
                        {"turns_to_frame", arm.wanted}});
    return arms;
}

/// Prints how far the arms turn; warns if one cannot fold, or a solid is not connected.
void print_glasses(const GlassesCommand& options, const LabeledInput& input, const Glasses& glasses,
                   const nlohmann::json& solids, double seconds) {
    fmt::print("{}: {}, arms turn by {:.0f} and {:.0f} degrees: {} in {:.1f} s\n", input.path.string(),
               counted(glasses.solids.size(), "solid"), glasses.arms[0].turns, glasses.arms[1].turns,
               options.out.string(), seconds);
    if (options.common.quiet) return;
    for (const nlohmann::json& solid : solids)
        if (const auto pieces = solid["pieces"].get<std::size_t>(); pieces > 1)
            fmt::print(stderr, "warning: {}: {} falls into {} pieces; make --rim or --width larger\n",
                       input.path.string(), solid["file"].get<std::string>(), pieces);
    for (const GlassesArm& arm : glasses.arms)
        if (arm.turns < arm.wanted)
            fmt::print(stderr,
                       "warning: {}: {} touches the frame after {:.0f} of the {:.0f} degrees that fold it; what lies "
                       "behind the lenses there is in the way\n",
                       input.path.string(), arm.name, arm.turns, arm.wanted);
}

void run_glasses(const GlassesCommand& options) {
    const auto limits = apply_common_options(options.common);
    const Stopwatch watch;
    require_output_folder(options.out);
    const LabeledInput input = read_labeled_input(options.input, options.common);
    require_other_folder(options.out, {input.path});
    const Glasses glasses =
        of_file(input.path, [&] { return make_glasses(input.file.mesh, input.names, input.label, options.glasses); });
    const nlohmann::json solids = write_solids(glasses.solids, options.out);
    nlohmann::json outlines = nlohmann::json::array();
    for (const GlassesLens& lens : glasses.lenses) {
        outlines.push_back(lens.name + ".svg");
        write_outline(options.out / outlines.back().get<std::string>(), lens);
    }
    print_glasses(options, input, glasses, solids, watch.wall());
    write_report(options.common, {{"mesh", input.path.string()},
                                  {"labels", input.source},
                                  {"out", options.out.string()},
                                  {"cell", glasses.cell},
                                  {"solids", solids},
                                  {"outlines", outlines},
                                  {"arms", describe_arms(glasses)},
                                  {"seconds", watch.wall()}});
}

void add_glasses_options(Command& command, GlassesOptions& options) {
    command.add_option("--width", options.width, "of the frame, in mm")
        ->capture_default_str()
        ->check(in_range(20.0, 1000.0));
    command.add_option("--rim", options.rim, "width of the rim around the lenses, in mm")
        ->capture_default_str()
        ->check(in_range(0.1, 100.0));
    command.add_option("--sheet", options.sheet, "thickness of the sheet of the lenses, in mm")
        ->capture_default_str()
        ->check(in_range(0.1, 100.0));
    command.add_option("--gap", options.gap, "gap between solids that move or are put together, in mm")
        ->capture_default_str()
        ->check(in_range(0.01, 10.0));
    command.add_option("--resolution", options.resolution, "cells across the width")
        ->capture_default_str()
        ->check(whole_number(50, 1000));
    command.add_option("--lens", options.lens, "label of the lenses (default: lens or glass)")->type_name("LABEL");
    command.add_option("--arm", options.arm, "label of the arms (default: arm, temple or skeleton)")
        ->type_name("LABEL");
}

}  // namespace

void add_glasses_command(Command& prototype) {
    auto options = std::make_shared<GlassesCommand>();
    Command* command =
        prototype.add_subcommand("glasses", "Makes glasses to print, with hinges, and their lenses to cut");
    command->footer(
        "Writes frame.stl, arm_left.stl, arm_right.stl, lens_left.stl, lens_right.stl and all.stl, in millimeters, "
        "and\n"
        "the outlines of the lenses as lens_left.svg and lens_right.svg. Print frame and arms in place, as in "
        "all.stl:\n"
        "the pins are in the knuckles. The mesh must be closed.\n\nExample:\n"
        "  exemplar label prototype glasses glasses.off --width 135 --out glasses");
    add_labeled_input(*command, options->input, options->common);
    command->add_option("--out", options->out, "folder to write to")->required()->type_name("FOLDER");
    add_glasses_options(*command, options->glasses);
    add_common_options(*command, options->common);
    command->callback([options] { run_glasses(*options); });
}

}  // namespace exemplar
