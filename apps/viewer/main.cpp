// exemplar-viewer: shows meshes and animations, with what was learned of them. Exit codes: 0 success, 1 error (one line
// on stderr), 2 wrong usage, 130 interrupted.

#include <fmt/format.h>

#include <charconv>
#include <cstdio>

#include "apps/help/help_pages.h"
#include "apps/viewer/scene/hatched_still.h"
#include "apps/viewer/scene/options.h"
#include "host/core/errors.h"
#include "host/core/freed_memory.h"
#include "host/core/progress.h"
#include "host/core/run_program.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

const Choices<SurfacePaint> k_paint_choices{{"gauss", SurfacePaint::gaussian_curvature},
                                            {"k1", SurfacePaint::first_curvature},
                                            {"k2", SurfacePaint::second_curvature},
                                            {"labels", SurfacePaint::faces},
                                            {"mean", SurfacePaint::mean_curvature},
                                            {"normals", SurfacePaint::normals},
                                            {"plain", SurfacePaint::plain}};
const Choices<SurfaceLight> k_lights{{"flat", SurfaceLight::flat},
                                     {"none", SurfaceLight::none},
                                     {"smooth", SurfaceLight::smooth},
                                     {"steps", SurfaceLight::steps}};
const Choices<ShownCurvature> k_sources{
    {"both", ShownCurvature::both}, {"estimated", ShownCurvature::estimated}, {"learned", ShownCurvature::learned}};
const Choices<ViewSide> k_sides{{"back", ViewSide::back}, {"bottom", ViewSide::bottom}, {"front", ViewSide::front},
                                {"left", ViewSide::left}, {"right", ViewSide::right},   {"top", ViewSide::top}};

std::vector<std::string> line_words() {
    std::vector<std::string> names{"none"};
    for (const LineType type : k_line_types) names.emplace_back(name_of(type));
    return names;
}

// "contours,ridges"; "none" for no lines.
std::vector<LineType> parse_lines(const std::vector<std::string>& words) {
    std::vector<LineType> types;
    const std::vector<std::string> names = line_words();
    for (const std::string& word : words) {
        const std::optional<LineType> type = word == "none" ? std::nullopt : line_type_from_prefix(word);
        if (!type && word != "none")
            throw UsageError(fmt::format("there are no lines '{}'{}", word, suggestion(word, names)));
        if (type) types.push_back(*type);
    }
    return types;
}

ViewSize parse_size(const std::string& text) {
    constexpr int k_largest = 16384;
    ViewSize size{0, 0};
    const char* const end = text.data() + text.size();
    const auto [middle, width_error] = std::from_chars(text.data(), end, size.width);
    if (width_error == std::errc() && middle != end && *middle == 'x') {
        const auto [stop, height_error] = std::from_chars(middle + 1, end, size.height);
        if (height_error == std::errc() && stop == end && size.width > 0 && size.height > 0 &&
            size.width <= k_largest && size.height <= k_largest)
            return size;
    }
    throw UsageError(fmt::format("'{}' is no size; write WIDTHxHEIGHT, up to {} each", text, k_largest));
}

void add_options(Command& app, ViewerOptions& options, std::string& size) {
    app.add_option("FILE", options.file,
                   "mesh (OFF, OBJ, PLY, STL, glTF, and where exemplar-import is installed FBX, COLLADA, 3MF, 3DS), "
                   "animation (glTF, "
                   "FBX, COLLADA), or folder of meshes")
        ->type_name("");
    app.add_flag("--label", options.label, "paints labels on the mesh, or on the meshes of the folder");
    app.add_option("--model", options.model,
                   "model of the animation's curvature, .safetensors; with --label, a model of 'exemplar label train'")
        ->type_name("FILE");
    app.add_option("--script", options.script, "with --headless and --label: paints by the commands of a file")
        ->type_name("FILE");
    app.add_option("--hatching", options.hatching, "style of 'exemplar hatch train' for hatched stills, .safetensors")
        ->type_name("FILE");
    app.add_option("--save-hatching", options.hatched_still,
                   "with --headless and --hatching: draws a hatched still, .svg or .png, instead of frames")
        ->type_name("FILE");
    app.add_option("--clip", options.clip, "clip to play; default: the first")->type_name("NAME");
    app.add_option("--first-frame", options.first_frame, "frame of the clip to begin with; a window stands there");
    app.add_list_option(
           "--lines", [&options](const std::vector<std::string>& words) { options.lines = parse_lines(words); },
           "lines to draw, as in contours,suggestive_contours (the default); none for no lines")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(completion_words(line_words()))
        ->type_name("TYPE");
    app.add_option("--style", options.style, "style of the drawing: a built-in name or a file")
        ->check(completion_words(builtin_style_names()))
        ->type_name("NAME|FILE");
    add_choice(app, "--paint", options.paint, k_paint_choices, "colors: labels, curvature (mean, gauss, k1, k2), ...");
    add_choice(app, "--light", options.light, k_lights, "shading");
    add_choice(app, "--curvature", options.source, k_sources, "curvature that is shown");
    add_choice(app, "--side", options.side, k_sides, "side to look from");
    app.add_flag("--parallel", options.parallel, "parallel projection");
    app.add_option("--size", size, "size of window or pictures, in pixels")->capture_default_str()->type_name("WxH");
    app.add_option("--device", options.device, "Vulkan device: index or part of its name (see 'exemplar devices')")
        ->type_name("NAME");
    app.add_flag("--headless", options.headless, "draws without a window");
    app.add_option("--frames", options.frames, "frames to draw before it ends; 0: until the window is closed")
        ->capture_default_str();
    app.add_option("--out", options.out,
                   "with --headless: folder for frame_0000.png and so on; none is written without")
        ->type_name("FOLDER");
    app.add_flag("--plain", options.plain_window, "shows no panels to begin with");
    app.add_flag("--quiet", options.quiet, "no progress and no remarks");
    app.add_option("--lose-device-at", options.losing_frame, "")->hide();
    app.add_option("--fail-at", options.failing_frame, "")->hide();
}

void require_still_options(const ViewerOptions& options) {
    if (!options.headless || options.hatching.empty())
        throw UsageError("--save-hatching needs --headless and --hatching");
    if (!options.out.empty() || options.frames > 0)
        throw UsageError("--save-hatching draws no frames; leave out --frames and --out");
    require_still_name(options.hatched_still);
}

void require_label_options(const ViewerOptions& options) {
    if (options.label && options.file.empty()) throw UsageError("--label needs a FILE or a folder of meshes");
    if (!options.script.empty() && (!options.headless || !options.label))
        throw UsageError("--script needs --headless and --label");
    if (options.headless && options.label && options.script.empty())
        throw UsageError("--headless --label needs a --script");
}

int run(int argc, char** argv) {
    keep_freed_memory();
    Command app("exemplar-viewer", "Shows meshes and animations, with their curvature estimated and learned.");
    app.footer(
        "F1 in the window shows its keys.\n"
        "Exit codes: 0 done, 1 error (one line says what), 2 wrong usage, 130 interrupted.\n\nExamples:\n"
        "  exemplar synth figure --seed 1 --out shapes\n"
        "  exemplar-viewer shapes/figure_001.glb\n"
        "  exemplar-viewer shapes/figure_001.glb --headless --frames 30 --out frames\n"
        "  exemplar-viewer bunny.off --headless --hatching mine.safetensors --save-hatching bunny.svg\n"
        "  exemplar-viewer shapes --label");
    app.version(EXEMPLAR_VERSION);
    ViewerOptions options;
    std::string size = "1280x720";
    add_options(app, options, size);
    add_help_pages_option(app, EXEMPLAR_VERSION);
    if (const std::optional<int> exit_code = app.parse(argc, argv)) return *exit_code;
    options.size = parse_size(size);
    if (!options.headless && !options.out.empty()) throw UsageError("--out needs --headless");
    if (!options.hatched_still.empty()) require_still_options(options);
    require_label_options(options);
    Progress::set_quiet(options.quiet);
    options.headless ? run_headless(options) : run_window(options);
    return 0;
}

}  // namespace
}  // namespace exemplar

int main(int argc, char** argv) {
    return exemplar::run_program(exemplar::run, argc, argv);
}
