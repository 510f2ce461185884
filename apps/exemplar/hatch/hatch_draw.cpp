// exemplar hatch draw: a view in a learned style.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/common_options.h"
#include "apps/exemplar/hatch/hatch_draw.h"
#include "apps/exemplar/ink_arguments.h"
#include "apps/help/command.h"
#include "host/core/errors.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/hatching/refinement/stroke_statistics.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

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
        const std::vector<float>& values = property_of(fields, property);
        write(name_of(property), property_picture(values, fields.level, fields.width, fields.height,
                                                  property_range(values, fields.level)));
    }
}

nlohmann::json seconds_of(const HatchScene& scene, const ViewHatching& hatching) {
    nlohmann::json seconds = {{"targets", hatching.prediction_seconds}, {"strokes", hatching.stroke_seconds}};
    for (const auto& [step, time] : scene.surface().seconds) seconds["surface: " + step] = time;
    for (const auto& [step, time] : hatching.prediction.seconds) seconds[std::string("targets: ") + step] = time;
    return seconds;
}

void draw_still(const HatchDrawJob& job) {
    HatchingStyle style = load_hatching_style(job.style);
    Progress progress("drawing", 4);
    Stopwatch watch;
    HatchScene scene(job.scene, job.common.device, job.common.quiet);
    const double surface_seconds = watch.wall();
    progress.advance(1, "surface");
    style.resize(scene.pixels().view().width, scene.pixels().view().height);
    const ViewHatching hatching = hatch_view(style, scene.pixels(), scene.tools(), job.hatching);
    const HatchingFields& fields = hatching.prediction.fields;
    progress.advance(2, "strokes");
    watch = {};
    const SpacingMeasure spacing = measure_spacing(hatching.strokes, fields);
    const ToneMeasure tone = measure_tone(hatching.strokes, fields);
    HatchedDrawing drawing{fields.width, fields.height, hatching.strokes, {}, scene.inks()};
    taper_strokes(drawing.strokes, job.taper_of(style));
    const DrawingStyle look = curve_look(style);
    drawing.curves = feature_curves(scene.surface(), scene.pixels().view(), job.curve_types(), look);
    write_hatched_drawing(job, drawing, look);
    if (!job.properties.empty()) write_properties(job.properties, hatching.prediction);
    progress.advance(1, "output");
    progress.finish();
    if (!job.common.quiet)
        fmt::print("{}: {}; spacing off by {:.0f}%, tone by {:.0f}% in the median\n", job.out.string(),
                   counted(drawing.strokes.size(), "stroke"), 100 * spacing.median_error, 100 * tone.median_error);
    nlohmann::json seconds = seconds_of(scene, hatching);
    seconds["surface"] = surface_seconds;
    seconds["output"] = watch.wall();
    write_report(job.common, {{"mesh", job.scene.mesh.string()},
                              {"style", style.name},
                              {"device", scene.device_name()},
                              {"faces", scene.surface().mesh.face_count()},
                              {"pixels", scene.pixels().size()},
                              {"strokes", drawing.strokes.size()},
                              {"spacing_error", spacing.median_error},
                              {"tone_error", tone.median_error},
                              {"seconds", seconds}});
}

void run_draw(HatchDrawJob& job) {
    const auto limits = apply_common_options(job.common);
    require_input(job.style);
    require_hatch_scene(job.scene);
    job.curve_types();
    job.output = lines_output_of(job.out);
    job.source.input = job.scene.mesh;
    job.source.first_frame_only = job.is_single_picture();
    job.source.measuring.curvature.derivatives = false;
    job.source.quiet = job.common.quiet;
    if (job.output == LinesOutput::folder)
        require_output_folder(job.out);
    else
        require_output_file(job.out);
    require_not_replaced(job.out, {job.scene.mesh, job.style});
    if (!job.properties.empty()) require_output_folder(job.properties);
    job.has_frames() ? write_hatched_frames(job) : draw_still(job);
}

void add_frames_options(Command& command, HatchDrawJob& job) {
    add_frame_options(command, job.source.frames, "", "draw");
    command.add_option("--fps", job.source.frames_per_second, k_fps_option)
        ->capture_default_str()
        ->check(in_range(0.1, 1000.0));
    command
        .add_option("--turn", job.turn,
                    "degrees that the object turns by from a frame to the next; a mesh turns all around, or for as "
                    "many frames as --frames says")
        ->type_name("DEGREES")
        ->check(in_range(-90.0, 90.0));
    command.add_flag("--fresh", job.fresh, "draws each frame anew, instead of keeping strokes on the surface");
    command.add_flag("--remeasure", job.remeasure,
                     "measures each frame's surface as a whole, instead of keeping what changes slowly");
}

std::vector<std::string> curve_words() {
    std::vector<std::string> words{"none"};
    for (const LineType type : k_line_types) words.emplace_back(name_of(type));
    return words;
}

}  // namespace

std::vector<LineType> HatchDrawJob::curve_types() const {
    std::vector<LineType> types;
    for (const std::string& word : curves) {
        if (word == "none") continue;
        const auto type = line_type_from_prefix(word);
        if (!type)
            throw UsageError(fmt::format("--curves '{}' is no type of lines; see 'exemplar lines --help'", word));
        types.push_back(*type);
    }
    return types;
}

void write_hatched_drawing(const HatchDrawJob& job, const HatchedDrawing& drawing, const DrawingStyle& look) {
    if (job.output != LinesOutput::svg) {
        write_png(job.out, hatching_picture(drawing, look, job.scale));
        return;
    }
    SvgOptions options;
    options.form = job.outlines ? SvgForm::outlines : SvgForm::lines;
    options.title = job.scene.mesh.stem().string();
    write_hatching_svg(job.out, drawing, look, options);
}

void add_hatch_draw_command(Command& hatch) {
    auto arguments = std::make_shared<HatchDrawJob>();
    Command* command = hatch.add_subcommand("draw", "Draws a mesh or an animation in a learned style");
    command->footer(
        "Examples:\n"
        "  exemplar hatch draw mine.safetensors cow.obj --out cow.svg\n"
        "  exemplar hatch draw mine.safetensors cow.obj --view side --curves contours,suggestive --out cow.png\n"
        "  exemplar hatch draw mine.safetensors cow.obj --labels cow_labels.txt --materials inks.json --out cow.svg\n"
        "  exemplar hatch draw mine.safetensors figure.glb --frames 0:60 --out walk.mp4\n"
        "  exemplar hatch draw mine.safetensors cow.obj --turn 3 --out turning");
    command->add_option("STYLE", arguments->style, "style file of 'exemplar hatch train'")->required()->type_name("");
    command->add_option("MESH", arguments->scene.mesh, k_surface_argument)->required()->type_name("");
    command
        ->add_option("--out", arguments->out,
                     "what to write: .svg, .png, .mp4, or a folder for a picture of each frame")
        ->required()
        ->type_name("FILE|FOLDER");
    command
        ->add_option("--curves", arguments->curves,
                     "feature curves drawn with it, as 'exemplar lines --types' has them, or none")
        ->type_name("TYPE")
        ->check(completion_words(curve_words()))
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    command
        ->add_option(
            "--labels", arguments->scene.labels,
            "labels of the mesh's faces (_labels.txt, .seg or labeled PLY), for --materials and for a style that "
            "was learned with labels")
        ->type_name("FILE");
    add_materials_option(*command, arguments->scene.materials);
    command->add_option("--properties", arguments->properties, "writes a picture of each property into this folder")
        ->type_name("FOLDER");
    command
        ->add_option("--taper", arguments->taper,
                     "pixels over which strokes end in a point; 0: blunt; default: as in the style's drawing")
        ->type_name("FLOAT")
        ->check(in_range(0.0, 1000.0));
    command->add_option("--scale", arguments->scale, "enlarges PNG pictures")
        ->capture_default_str()
        ->check(in_range(0.1, 16.0));
    command->add_flag_callback(
        "--no-tone", [job = arguments.get()] { job->hatching.matches_tone = false; },
        "leaves strokes as thick as learned, not matched to the tone");
    command->add_flag("--outlines", arguments->outlines, "SVG with filled shapes of varying width, not center lines");
    command->add_option("--seed", arguments->hatching.strokes.seed, "of the placement of strokes")
        ->capture_default_str()
        ->check(whole_number(0));
    add_template_option(*command, arguments->scene, add_hatch_scene_options(*command, arguments->scene));
    add_frames_options(*command, *arguments);
    add_device_option(*command, arguments->common);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_draw(*arguments); });
}

}  // namespace exemplar
