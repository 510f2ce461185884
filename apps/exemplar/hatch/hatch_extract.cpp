// exemplar hatch extract: what a drawing's strokes are like, as pictures.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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
    fs::path drawing, mask, out;
    std::size_t page = 0;
    CommonOptions common;
};

/// The drawing in light gray; the center line of each stroke over it in a color of its own, drawn outlines in black.
Image traced_picture(const FloatImage& darkness, const StrokeMeasurements& m) {
    constexpr std::array<std::array<std::uint8_t, 3>, 6> k_colors{
        {{204, 0, 0}, {0, 102, 204}, {0, 140, 40}, {190, 100, 0}, {140, 0, 170}, {0, 140, 150}}};
    Image image(m.width, m.height, 3);
    for (std::size_t i = 0; i < m.size(); ++i) {
        const float light = 1 - 0.4f * std::clamp(darkness.data[i], 0.0f, 1.0f);
        std::array<std::uint8_t, 3> color{};
        color.fill(static_cast<std::uint8_t>(std::lround(255 * light)));
        if (m.outline[i]) color = {};
        if (m.skeleton[i]) color = k_colors[static_cast<std::size_t>(m.stroke_id[i]) % k_colors.size()];
        std::ranges::copy(color, image.data.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return image;
}

Image mask_picture(std::span<const std::uint8_t> mask, int width, int height) {
    Image image(width, height, 1);
    for (std::size_t i = 0; i < mask.size(); ++i) image.data[i] = mask[i] ? 0 : 255;
    return image;
}

nlohmann::json write_measurement_pictures(const fs::path& folder, const AlignedDrawing& drawing) {
    const StrokeMeasurements& m = drawing.strokes;
    fs::create_directories(folder);
    const auto write = [&](const char* name, const Image& image) {
        write_png(folder / fmt::format("{}.png", name), image);
    };
    write("overlay", traced_picture(drawing.darkness, m));
    write("skeleton", mask_picture(m.skeleton, m.width, m.height));
    write("intersections", mask_picture(m.intersection, m.width, m.height));
    write("boundaries", mask_picture(m.boundary, m.width, m.height));
    write("levels", label_picture(m.level, 0, m.width, m.height));
    write("orientation", orientation_picture(m.orientation, m.stroke, m.width, m.height));
    const DrawingProperties properties = drawing_properties(m);
    nlohmann::json ranges;
    for (std::size_t p = 0; p < k_stroke_properties; ++p) {
        const char* name = name_of(static_cast<StrokeProperty>(p));
        const std::array<float, 2> range = property_range(properties.property[p], m.stroke);
        write(name, property_picture(properties.property[p], m.stroke, m.width, m.height, range));
        ranges[name] = range;
    }
    return ranges;
}

void run_extract(ExtractArguments& arguments) {
    const auto limits = apply_common_options(arguments.common);
    require_hatch_scene(arguments.scene);
    require_input(arguments.drawing);
    if (!arguments.mask.empty()) require_input(arguments.mask);
    require_output_folder(arguments.out);
    HatchScene scene(arguments.scene, arguments.common.device, arguments.common.quiet);
    AlignedDrawing drawing =
        read_drawing({arguments.drawing, arguments.page}, arguments.scene, scene.pixels(), arguments.common.quiet);
    if (!arguments.mask.empty()) restrict_to(read_mask(arguments.mask, scene.pixels()), drawing.strokes);
    const StrokeMeasurements& measured = drawing.strokes;
    const nlohmann::json ranges = write_measurement_pictures(arguments.out, drawing);
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
                                    {"taper", measured.taper},
                                    {"crossings", measured.intersections.size()},
                                    {"ranges", ranges}});
}

}  // namespace

void add_hatch_extract_command(Command& hatch) {
    auto arguments = std::make_shared<ExtractArguments>();
    Command* command = hatch.add_subcommand("extract", "Measures the strokes of a drawing, for inspection");
    command->footer(
        "Writes what was read over the drawing (overlay), and a picture of each property: skeleton, orientation, "
        "thickness, intensity, spacing, length, levels,\n"
        "intersections, boundaries.\n\nExample:\n"
        "  exemplar hatch extract bunny.off traced.png --template bunny.png --out properties");
    command->add_option("MESH", arguments->scene.mesh, "mesh that the drawing shows")->required()->type_name("");
    command->add_option("DRAWING", arguments->drawing, "the drawing (PNG, JPEG, TIFF or SVG)")
        ->required()
        ->type_name("");
    add_page_option(*command, arguments->page);
    command
        ->add_option("--mask", arguments->mask,
                     "picture of the view, white where to measure (PNG, JPEG or TIFF): black hides a signature, a "
                     "shadow, a slip of the pen")
        ->type_name("FILE");
    command->add_option("--out", arguments->out, "folder for the pictures")->required()->type_name("FOLDER");
    add_template_option(*command, arguments->scene, add_hatch_scene_options(*command, arguments->scene));
    add_device_option(*command, arguments->common);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_extract(*arguments); });
}

}  // namespace exemplar
