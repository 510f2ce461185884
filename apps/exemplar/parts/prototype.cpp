// exemplar label prototype: labeled meshes as things that can be printed and move. prototype mannequin.

#include <fmt/format.h>

#include <string>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/parts/labeled_input.h"
#include "apps/exemplar/parts/solid_output.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/parts/prototype/mannequin.h"

namespace exemplar {
namespace {

struct PrototypeCommand {
    CommonOptions common;
    LabeledInputArguments input;
    std::filesystem::path out;
    MannequinOptions mannequin;
};

const char* name_of_joint(PrintJointKind kind) {
    return kind == PrintJointKind::ball ? "ball" : kind == PrintJointKind::hinge ? "hinge" : "fused";
}

nlohmann::json describe_print_joints(const Mannequin& mannequin) {
    nlohmann::json joints = nlohmann::json::array();
    for (const PrintJoint& joint : mannequin.joints) {
        const Joint& child = mannequin.skeleton.joints[joint.joint];
        joints.push_back({{"joint", child.name},
                          {"parent", mannequin.skeleton.joints[child.parent].name},
                          {"kind", name_of_joint(joint.kind)},
                          {"center", {joint.center[0], joint.center[1], joint.center[2]}},
                          {"radius", joint.radius}});
    }
    return joints;
}

void run_mannequin(const PrototypeCommand& options) {
    const auto limits = apply_common_options(options.common);
    const Stopwatch watch;
    require_output_folder(options.out);
    const LabeledInput input = read_labeled_input(options.input, options.common);
    require_other_folder(options.out, {input.path});
    MannequinOptions making = options.mannequin;
    making.costs = pair_costs(input);
    const Mannequin mannequin =
        of_file(input.path, [&] { return make_mannequin(input.file.mesh, input.names, input.label, making); });
    const nlohmann::json solids = write_solids(mannequin.solids, options.out);
    std::size_t moving = 0;
    for (const PrintJoint& joint : mannequin.joints) moving += joint.kind != PrintJointKind::fused;
    fmt::print("{}: {}, {} that move: {} in {:.1f} s\n", input.path.string(), counted(mannequin.solids.size(), "solid"),
               counted(moving, "joint"), options.out.string(), watch.wall());
    write_report(options.common, {{"mesh", input.path.string()},
                                  {"labels", input.source},
                                  {"out", options.out.string()},
                                  {"cell", mannequin.cell},
                                  {"solids", solids},
                                  {"joints", describe_print_joints(mannequin)},
                                  {"seconds", watch.wall()}});
}

void add_mannequin_command(Command& prototype) {
    auto options = std::make_shared<PrototypeCommand>();
    Command* command = prototype.add_subcommand("mannequin", "Makes a jointed figure to print, a solid per part");
    command->footer(
        "Writes NAME.stl for each solid and all.stl, in millimeters. The balls of parts sit in sockets of the parts "
        "that\n"
        "they hang on; labels of --hinge bend about one axis. Parts too thin for a joint stay one solid.\n\nExample:\n"
        "  exemplar label prototype mannequin labeled.ply --root torso --height 150 --out mannequin");
    add_labeled_input(*command, options->input, options->common);
    command->add_option("--out", options->out, "folder to write to")->required()->type_name("FOLDER");
    command->add_option("--height", options->mannequin.height, "longest edge of the figure, in mm")
        ->capture_default_str()
        ->check(in_range(1.0, 10000.0));
    command->add_option("--gap", options->mannequin.gap, "gap between solids, in mm")
        ->capture_default_str()
        ->check(in_range(0.01, 100.0));
    command->add_option("--resolution", options->mannequin.resolution, "cells along the longest edge")
        ->capture_default_str()
        ->check(whole_number(20, 1000));
    command
        ->add_option("--root", options->mannequin.root,
                     "label of the part that all others hang on (default: the largest)")
        ->type_name("LABEL");
    command->add_option("--hinge", options->mannequin.hinges, "labels that hang on a hinge instead of a ball")
        ->type_name("LABEL ...");
    add_common_options(*command, options->common);
    command->callback([options] { run_mannequin(*options); });
}

}  // namespace

void add_prototype_command(Command& label) {
    Command* command = label.add_subcommand("prototype", "Makes things to print out of the parts of a mesh");
    command->footer(
        "Examples:\n"
        "  exemplar label prototype mannequin labeled.ply --out mannequin\n"
        "  exemplar label prototype glasses glasses.off --out glasses");
    command->require_subcommand();
    add_mannequin_command(*command);
    add_glasses_command(*command);
}

}  // namespace exemplar
