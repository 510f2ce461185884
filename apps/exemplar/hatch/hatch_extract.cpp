// exemplar hatch extract: what a drawing's strokes are like, as pictures.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/hatch/hatch_reading.h"
#include "apps/exemplar/hatch/hatch_scene.h"
#include "host/core/text.h"
#include "host/hatching/hatching_drawing.h"
#include "host/hatching/measurement/drawing_properties.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct ExtractArguments {
    HatchSceneArguments scene;
    fs::path drawing, out;
    CommonOptions common;
};

Image mask_picture(std::span<const std::uint8_t> mask, int width, int height) {
    Image image(width, height, 1);
    for (std::size_t i = 0; i < mask.size(); ++i) image.data[i] = mask[i] ? 0 : 255;
    return image;
}

nlohmann::json write_measurement_pictures(const fs::path& folder, const StrokeMeasurements& m) {
    fs::create_directories(folder);
    const auto write = [&](const char* name, const Image& image) {
        write_png(folder / fmt::format("{}.png", name), image);
    };
    write("skeleton", mask_picture(m.skeleton, m.width, m.height));
    write("intersections", mask_picture(m.intersection, m.width, m.height));
    write("boundaries", mask_picture(m.boundary, m.width, m.height));
    write("levels", label_picture(m.level, 0, m.width, m.height));
    write("orientation", orientation_picture(m.orientation, m.stroke, m.width, m.height));
    const DrawingProperties properties = drawing_properties(m);
    nlohmann::json ranges;
    for (std::size_t p = 0; p < k_stroke_properties; ++p) {
        const char* name = name_of(static_cast<StrokeProperty>(p));
        std::array<float, 2> range{};
        write(name, property_picture(properties.property[p], m.stroke, m.width, m.height, range));
        ranges[name] = range;
    }
    return ranges;
}

void run_extract(const ExtractArguments& arguments) {
    const auto limits = apply_common_options(arguments.common);
    require_hatch_scene(arguments.scene);
    require_input(arguments.drawing);
    require_output_folder(arguments.out);
    HatchScene scene(arguments.scene, arguments.common.device, arguments.common.quiet);
    const StrokeMeasurements measured = read_drawing(arguments.drawing, scene.pixels(), arguments.common.quiet);
    const nlohmann::json ranges = write_measurement_pictures(arguments.out, measured);
    if (!arguments.common.quiet) {
        fmt::print("{}: strokes {:.1f} pixels thick, {:.1f} apart in the median; {}\n", arguments.out.string(),
                   measured.median_thickness, measured.median_spacing,
                   counted(measured.intersections.size(), "crossing"));
        for (const auto& [name, range] : ranges.items())
            fmt::print("  {}: from {:.3g} (light) to {:.3g} (dark)\n", name, range[0].get<double>(),
                       range[1].get<double>());
    }
    write_report(arguments.common, {{"drawing", arguments.drawing.string()},
                                    {"median_thickness", measured.median_thickness},
                                    {"median_spacing", measured.median_spacing},
                                    {"crossings", measured.intersections.size()},
                                    {"ranges", ranges}});
}

}  // namespace

void add_hatch_extract_command(Command& hatch) {
    auto arguments = std::make_shared<ExtractArguments>();
    Command* command = hatch.add_subcommand("extract", "Measures the strokes of a drawing, for inspection");
    command->footer(
        "Writes a picture of each property: skeleton, orientation, thickness, intensity, spacing, length, levels,\n"
        "intersections, boundaries.\n\nExample:\n"
        "  exemplar hatch extract bunny.off traced.png --out properties");
    command->add_option("MESH", arguments->scene.mesh, "mesh that the drawing shows")->required()->type_name("");
    command->add_option("DRAWING", arguments->drawing, "the drawing (PNG)")->required()->type_name("");
    command->add_option("--out", arguments->out, "folder for the pictures")->required()->type_name("FOLDER");
    add_hatch_scene_options(*command, arguments->scene);
    add_device_option(*command, arguments->common);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_extract(*arguments); });
}

}  // namespace exemplar
