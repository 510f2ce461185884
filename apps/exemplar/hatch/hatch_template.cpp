// exemplar hatch template: a view to trace.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/common_options.h"
#include "apps/exemplar/hatch/hatch_scene.h"
#include "host/core/text.h"
#include "host/hatching/drawing/aligned_drawing.h"
#include "host/hatching/drawing/drawing_sheet.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

struct TemplateArguments {
    HatchSceneArguments scene;
    CommonOptions common;
    std::filesystem::path out;
    std::string sheet;
};

void run_template(TemplateArguments& arguments) {
    const auto limits = apply_common_options(arguments.common);
    require_hatch_scene(arguments.scene);
    require_output_picture(arguments.out);
    require_not_replaced(arguments.out, {arguments.scene.mesh});
    HatchScene scene(arguments.scene, arguments.common.device, arguments.common.quiet);
    const ViewFile shown{{arguments.scene.camera, arguments.scene.light},
                         drawn_mesh(arguments.scene.mesh, scene.surface().mesh),
                         arguments.sheet,
                         {}};
    PngText text{k_view_keyword, view_file_text(shown)};
    Image picture = drawing_template(scene.pixels());
    if (!arguments.sheet.empty()) {
        const DrawingSheet sheet = drawing_sheet(arguments.sheet, picture.width, picture.height);
        picture = printed_sheet(sheet, picture);
        text.pixels_per_mm = sheet.pixels_per_mm;
    }
    write_png(arguments.out, picture, text);
    if (!arguments.common.quiet)
        fmt::print(
            "{0}: trace it with strokes only; then 'exemplar hatch train {1} DRAWING --template {0} --out STYLE'\n",
            arguments.out.string(), arguments.scene.mesh.string());
    write_report(arguments.common, {{"mesh", arguments.scene.mesh.string()},
                                    {"width", scene.pixels().view().width},
                                    {"height", scene.pixels().view().height},
                                    {"pixels", scene.pixels().size()}});
}

}  // namespace

void add_hatch_template_command(Command& hatch) {
    auto arguments = std::make_shared<TemplateArguments>();
    Command* command = hatch.add_subcommand("template", "Renders a view of a mesh to draw on");
    command->footer(
        "On a screen, draw the strokes of hatching on a layer above it, and hand in the strokes alone, dark on light, "
        "at\n"
        "any resolution. On paper, print a --sheet, draw on it with a black pen, and scan or photograph it. The "
        "picture\n"
        "tells camera, light and mesh to the other commands (--template).\n\n"
        "Example:\n"
        "  exemplar hatch template bunny.off --view three-quarter --out bunny.png\n"
        "  exemplar hatch template bunny.off --view three-quarter --sheet a4 --out sheet.png");
    command->add_option("MESH", arguments->scene.mesh, k_mesh_argument)->required()->type_name("");
    command->add_option("--out", arguments->out, "the picture to write (PNG)")->required()->type_name("FILE");
    command
        ->add_option(
            "--sheet", arguments->sheet,
            fmt::format("a sheet of paper to print and draw on: {}; with the view in pale blue, marks by which "
                        "scans and photographs are read, and a scale",
                        fmt::join(paper_names(), ", ")))
        ->type_name("PAPER")
        ->check(one_of(paper_names()));
    add_hatch_scene_options(*command, arguments->scene);
    add_device_option(*command, arguments->common);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_template(*arguments); });
}

}  // namespace exemplar
