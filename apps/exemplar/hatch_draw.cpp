// exemplar hatch draw: a view in a learned style.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/hatch_scene.h"
#include "host/core/errors.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/hatching/hatching_drawing.h"
#include "host/hatching/line_directions.h"
#include "host/hatching/occlusion_barriers.h"
#include "host/hatching/stroke_statistics.h"
#include "host/hatching/tone_matching.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct DrawArguments {
    fs::path style, out, properties;
    HatchSceneArguments scene;
    CommonOptions common;
    std::vector<std::string> curves{"contours"};
    float taper = 6, scale = 1;
    bool no_tone = false, outlines = false;
    std::uint64_t seed = 1;
};

Drawing feature_curves(const HatchScene& scene, const HatchingView& view, const std::vector<std::string>& words,
                       const DrawingStyle& style) {
    Drawing drawing;
    std::vector<LineType> types;
    for (const std::string& word : words) {
        if (word == "none") continue;
        const auto type = line_type_meant(word);
        if (!type)
            throw UsageError(fmt::format("--curves '{}' is no type of lines; see 'exemplar lines --help'", word));
        types.push_back(*type);
    }
    StrokeView stroke_view;
    stroke_view.camera = view.camera;
    stroke_view.width = view.width;
    stroke_view.height = view.height;
    stroke_view.feature_size = scene.surface().feature_size;
    const BoundingBox box = bounding_box(scene.surface().mesh);
    const Vec3 middle = (0.5 * (box.low + box.high)).cast<float>();
    stroke_view.unit_depth = std::max(-(view.camera.view * middle.homogeneous()).z(), 1e-20f);
    return draw_lines(line_surface(scene.surface()), types, style, stroke_view);
}

void write_properties(const fs::path& folder, const HatchingPrediction& prediction) {
    fs::create_directories(folder);
    const HatchingFields& fields = prediction.fields;
    const auto write = [&](const char* name, const Image& image) {
        write_png(folder / fmt::format("{}.png", name), image);
    };
    write("segments", label_picture(prediction.segment, k_no_segment, fields.width, fields.height));
    write("levels", label_picture(fields.level, 0, fields.width, fields.height));
    std::vector<std::uint8_t> crossed(fields.size());
    for (std::size_t i = 0; i < crossed.size(); ++i) crossed[i] = fields.level[i] == k_cross_hatching ? 1 : 0;
    write("orientation", orientation_picture(fields.orientation[0], fields.level, fields.width, fields.height));
    write("cross_orientation", orientation_picture(fields.orientation[1], crossed, fields.width, fields.height));
    for (std::size_t p = 0; p < k_stroke_properties; ++p) {
        const auto property = static_cast<StrokeProperty>(p);
        std::array<float, 2> range{};
        write(name_of(property),
              property_picture(property_of(fields, property), fields.level, fields.width, fields.height, range));
    }
}

HatchedDrawing hatch(const DrawArguments& arguments, HatchScene& scene, const HatchingFields& fields) {
    HatchedDrawing drawing{fields.width, fields.height, {}, {}};
    StrokeOptions options;
    options.seed = arguments.seed;
    const auto barriers = occlusion_barriers(scene.pixels().gbuffer().depth, fields.width, fields.height);
    drawing.strokes = scene.placer().place(fields, barriers, options, {});
    if (!arguments.no_tone) match_tone(drawing.strokes, fields);
    return drawing;
}

void run_draw(const DrawArguments& arguments) {
    const auto limits = apply_common_options(arguments.common);
    require_input(arguments.style);
    require_hatch_scene(arguments.scene);
    const bool svg = arguments.out.extension() == ".svg";
    if (!svg && arguments.out.extension() != ".png")
        throw UsageError(fmt::format("{}: give a name that ends in .svg or .png", arguments.out.string()));
    require_output_file(arguments.out);
    const HatchingStyle style = load_hatching_style(arguments.style);
    Progress progress("drawing", 4);
    Stopwatch watch;
    HatchScene scene(arguments.scene, arguments.common.device, arguments.common.quiet);
    const double surface_seconds = watch.wall();
    progress.advance(1, "surface");
    watch = {};
    const HatchingPrediction prediction = predict_hatching(style, scene.pixels(), scene.scorer(), scene.evaluator());
    const double predict_seconds = watch.wall();
    progress.advance(1, "targets");
    watch = {};
    HatchedDrawing drawing = hatch(arguments, scene, prediction.fields);
    const SpacingMeasure spacing = measure_spacing(drawing.strokes, prediction.fields);
    const ToneMeasure tone = measure_tone(drawing.strokes, prediction.fields);
    taper_strokes(drawing.strokes, arguments.taper);
    progress.advance(1, "strokes");
    const double stroke_seconds = watch.wall();
    watch = {};
    const DrawingStyle look = load_style("ink");
    drawing.curves = feature_curves(scene, scene.pixels().view(), arguments.curves, look);
    if (svg) {
        SvgOptions options;
        options.form = arguments.outlines ? SvgForm::outlines : SvgForm::lines;
        options.title = arguments.scene.mesh.stem().string();
        write_hatching_svg(arguments.out, drawing, look, options);
    } else {
        write_png(arguments.out, hatching_picture(drawing, look, arguments.scale));
    }
    if (!arguments.properties.empty()) write_properties(arguments.properties, prediction);
    progress.finish();
    if (!arguments.common.quiet)
        fmt::print("{}: {}; spacing off by {:.0f}%, tone by {:.0f}% in the median\n", arguments.out.string(),
                   counted(drawing.strokes.size(), "stroke"), 100 * spacing.median_error, 100 * tone.median_error);
    nlohmann::json seconds = {{"surface", surface_seconds},
                              {"targets", predict_seconds},
                              {"strokes", stroke_seconds},
                              {"output", watch.wall()}};
    for (const auto& [step, time] : scene.surface().seconds) seconds["surface: " + step] = time;
    for (const auto& [step, time] : prediction.seconds) seconds[std::string("targets: ") + step] = time;
    write_report(arguments.common, {{"mesh", arguments.scene.mesh.string()},
                                    {"style", style.name},
                                    {"device", scene.device_name()},
                                    {"faces", scene.surface().mesh.face_count()},
                                    {"pixels", scene.pixels().size()},
                                    {"strokes", drawing.strokes.size()},
                                    {"spacing_error", spacing.median_error},
                                    {"tone_error", tone.median_error},
                                    {"seconds", seconds}});
}

}  // namespace

void add_hatch_draw_command(CLI::App& hatch) {
    auto arguments = std::make_shared<DrawArguments>();
    CLI::App* command = hatch.add_subcommand("draw", "Draws a mesh in a learned style");
    command->footer(
        "Examples:\n"
        "  exemplar hatch draw mine.safetensors cow.obj --out cow.svg\n"
        "  exemplar hatch draw mine.safetensors cow.obj --view side --curves contours,suggestive --out cow.png");
    command->add_option("STYLE", arguments->style, "style file of 'exemplar hatch train'")->required()->type_name("");
    command->add_option("MESH", arguments->scene.mesh, "mesh (OFF, OBJ, PLY, STL, glTF)")->required()->type_name("");
    command->add_option("--out", arguments->out, "what to write: .svg or .png")->required()->type_name("FILE");
    command
        ->add_option("--curves", arguments->curves,
                     "feature curves drawn with it, as 'exemplar lines --types' has them, or none")
        ->type_name("TYPE")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    command->add_option("--properties", arguments->properties, "writes a picture of each property into this folder")
        ->type_name("FOLDER");
    command->add_option("--taper", arguments->taper, "pixels over which strokes end in a point; 0: blunt")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1000.0));
    command->add_option("--scale", arguments->scale, "enlarges PNG pictures")
        ->capture_default_str()
        ->check(CLI::Range(0.1, 16.0));
    command->add_flag("--no-tone", arguments->no_tone, "leaves strokes as thick as learned, not matched to the tone");
    command->add_flag("--outlines", arguments->outlines, "SVG with filled shapes of varying width, not center lines");
    command->add_option("--seed", arguments->seed, "of the placement of strokes")
        ->capture_default_str()
        ->check(whole_number(0));
    add_hatch_scene_options(*command, arguments->scene);
    add_device_option(*command, arguments->common);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_draw(*arguments); });
}

}  // namespace exemplar
