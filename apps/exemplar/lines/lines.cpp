// exemplar lines: line drawings of meshes and animations.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/common_options.h"
#include "apps/exemplar/lines/lines_comparison.h"
#include "apps/exemplar/lines/lines_job.h"
#include "apps/help/command.h"
#include "host/core/errors.h"
#include "host/core/freed_memory.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

/// Command-line arguments before parsing.
struct LinesArguments {
    LinesJob job;
    std::vector<std::string> types = {"contours", "suggestive_contours", "boundaries"};
    std::vector<std::string> thresholds;
    std::string style = "ink", form = "lines", fading;
    std::string print_style;
    bool no_background = false;
};

std::vector<std::string> type_words() {
    std::vector<std::string> words = {"all"};
    for (const LineType type : k_line_types) words.emplace_back(name_of(type));
    return words;
}

LineType type_of(const std::string& word) {
    if (const std::optional<LineType> type = line_type_from_prefix(word)) return *type;
    const std::vector<std::string> words = type_words();
    throw UsageError(fmt::format("'{}' is no type of lines{}; the types are {}", word, suggestion(word, words),
                                 fmt::join(words, ", ")));
}

std::vector<LineType> types_of(const std::vector<std::string>& words) {
    std::vector<LineType> wanted;
    for (const std::string& word : words) {
        if (word == "all")
            wanted.assign(k_line_types.begin(), k_line_types.end());
        else
            wanted.push_back(type_of(word));
    }
    std::vector<LineType> types;
    for (const LineType type : drawing_order())
        if (std::find(wanted.begin(), wanted.end(), type) != wanted.end()) types.push_back(type);
    return types;
}

/// "valleys=0.2"
void set_threshold_of_word(const std::string& word, DrawingStyle& style) {
    const std::size_t equals = word.find('=');
    float value = 0;
    const char* end = word.data() + word.size();
    const char* begin = equals == std::string::npos ? end : word.data() + equals + 1;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (begin == end || error != std::errc() || stop != end)
        throw UsageError(fmt::format("--threshold '{}' is none; write TYPE=NUMBER as valleys=0.2", word));
    const LineType type = type_of(word.substr(0, equals));
    LineThresholds checked;
    set_threshold(checked, type, value);
    style.of(type).threshold = value;
}

std::vector<std::string> form_words() {
    return {"lines", "outlines"};
}
std::vector<std::string> fading_words() {
    return {"opacity", "width", "none"};
}

/// Returns the value whose number is the index of the word in `words`.
template <typename Value>
Value choice(const std::string& word, const char* option, const std::vector<std::string>& words) {
    const auto at = std::find(words.begin(), words.end(), word);
    if (at == words.end())
        throw UsageError(fmt::format("{} '{}' is not known{}; give one of {}", option, word, suggestion(word, words),
                                     fmt::join(words, ", ")));
    return static_cast<Value>(at - words.begin());
}

void require_comparable(const LinesJob& job) {
    if (job.output == LinesOutput::svg)
        throw UsageError(fmt::format("{}: --compare makes pictures; give a name that ends in .png or .mp4, or a folder",
                                     job.out.string()));
    if (job.source.model.empty())
        throw UsageError("--compare sets lines of learned curvature beside those of measured; give --model");
    if (types_to_compare(job.types).empty())
        throw UsageError(
            "--compare: these --types are the same by any curvature; add suggestive_contours, for example");
}

LinesJob job_of(const LinesArguments& arguments) {
    LinesJob job = arguments.job;
    if (job.source.input.empty()) throw UsageError("no MESH or ANIM is given; see 'exemplar lines --help'");
    if (job.out.empty()) throw UsageError("--out is missing; give the file to write, as drawing.svg");
    job.output = lines_output_of(job.out);
    if (job.output == LinesOutput::folder)
        require_output_folder(job.out);
    else
        require_output_file(job.out);
    require_camera(job.camera);
    require_inks(job.source.inks);
    job.types = types_of(arguments.types);
    if (job.compare) require_comparable(job);
    job.style = load_style(arguments.style);
    for (const std::string& word : arguments.thresholds) set_threshold_of_word(word, job.style);
    job.svg.form = choice<SvgForm>(arguments.form, "--form", form_words());
    const std::string fading = !arguments.fading.empty()        ? arguments.fading
                               : job.svg.form == SvgForm::lines ? "opacity"
                                                                : "width";
    job.svg.fading = choice<SvgFading>(fading, "--fading", fading_words());
    job.svg.background = !arguments.no_background;
    job.source.measuring.curvature.derivatives = std::any_of(job.types.begin(), job.types.end(), needs_curvature);
    job.source.measuring.cut_curvature =
        std::find(job.types.begin(), job.types.end(), LineType::creases) != job.types.end();
    job.source.measuring.crease_angle = job.style.thresholds(LineType::creases).crease_angle;
    job.source.first_frame_only = job.output == LinesOutput::svg || job.output == LinesOutput::picture;
    if (arguments.no_background) job.style.background.reset();
    job.source.quiet = job.common.quiet;
    return job;
}

void run_lines(const LinesArguments& arguments) {
    keep_freed_memory();
    const auto limits = apply_common_options(arguments.job.common);
    if (!arguments.print_style.empty()) {
        fmt::print("{}", builtin_style_text(arguments.print_style));
        return;
    }
    const LinesJob job = job_of(arguments);
    if (job.output == LinesOutput::svg)
        write_lines_svg(job);
    else
        write_lines_pictures(job);
}

void add_look_options(Command& command, LinesArguments& arguments) {
    command
        .add_option("--types", arguments.types,
                    fmt::format("lines to draw, separated by commas; the first letters will do: {}",
                                fmt::join(type_words(), ", ")))
        ->type_name("TYPE")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(completion_words(type_words()))
        ->capture_default_str();
    command
        .add_option("--style", arguments.style,
                    fmt::format("how they look: {}, or a style file (JSON)", fmt::join(builtin_style_names(), ", ")))
        ->type_name("NAME|FILE")
        ->check(completion_words(builtin_style_names()))
        ->capture_default_str();
    command
        .add_option("--labels", arguments.job.source.inks.labels,
                    "labels of the mesh's faces for --materials (default: those in its file or beside it)")
        ->type_name("FILE");
    add_materials_option(command, arguments.job.source.inks.materials);
    command.add_option("--print-style", arguments.print_style, "prints a built-in style, to start a file from")
        ->check(completion_words(builtin_style_names()))
        ->type_name("NAME");
    command
        .add_option("--threshold", arguments.thresholds,
                    "how strong lines of a type must be, as valleys=0.2; of creases the angle in degrees")
        ->type_name("TYPE=NUMBER")
        ->delimiter(',')
        ->allow_extra_args(false);
    command
        .add_option("--smoothing", arguments.job.source.measuring.curvature.smoothing,
                    "width, in edge lengths, that measured curvature is smoothed with")
        ->capture_default_str()
        ->check(in_range(0.0, 100.0));
}

void add_svg_options(Command& command, LinesArguments& arguments) {
    command
        .add_option("--form", arguments.form,
                    "lines: center lines with a stroke width, for plotters; outlines: filled shapes of varying width")
        ->type_name("FORM")
        ->check(completion_words(form_words()))
        ->capture_default_str();
    command
        .add_option("--fading", arguments.fading,
                    "weak lines fade by opacity (default of lines), width (of outlines), or not (none)")
        ->check(completion_words(fading_words()))
        ->type_name("HOW");
    command.add_flag("--curves", arguments.job.svg.curves, "center lines of Bezier curves, which stay smooth enlarged");
    command
        .add_option("--tolerance", arguments.job.svg.tolerance,
                    "pixels that paths may be off where that saves points; more than the default calms uneven lines")
        ->capture_default_str()
        ->check(in_range(0.0, 100.0));
    command.add_flag("--no-background", arguments.no_background, "leaves the background out");
}

}  // namespace

LinesOutput lines_output_of(const std::filesystem::path& path) {
    const std::string extension = lower_case(path.extension().string());
    if (extension == ".svg") return LinesOutput::svg;
    if (extension == ".png") return LinesOutput::picture;
    for (const char* video : {".mp4", ".mkv", ".webm", ".mov"})
        if (extension == video) return LinesOutput::video;
    if (extension.empty()) return LinesOutput::folder;
    throw UsageError(fmt::format("{}: '{}' is not written; give a name that ends in .svg, .png or .mp4, or a folder",
                                 path.string(), extension));
}

nlohmann::json report_outline(const LinesJob& job, const OutlineCheck& check) {
    if (!job.common.quiet)
        fmt::print(
            "outline: {:.1f} % of the silhouette has a line within {} pixels; {:.1f} % of contours are on no edge\n",
            100 * check.outlined_share(), k_outline_reach, 100 * check.stray_share());
    return {{"silhouette_pixels", check.silhouette},
            {"outlined", check.outlined_share()},
            {"contour_pixels", check.contours},
            {"stray", check.stray_share()}};
}

nlohmann::json describe_job(const LinesJob& job, const LinesSource& source, const StrokeView& view) {
    std::vector<float> matrix;
    const Eigen::Matrix4f view_projection = view.camera.view_projection();
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) matrix.push_back(view_projection(row, column));
    return {{"input", job.source.input.string()},
            {"output", job.out.string()},
            {"model", job.source.model.string()},
            {"style", job.style.name},
            {"faces", source.faces().size()},
            {"vertices", source.vertex_count()},
            {"frames", source.frame_count()},
            {"width", view.width},
            {"height", view.height},
            {"feature_size", view.feature_size},
            {"view_projection", matrix}};
}

void add_lines_command(Command& app) {
    auto arguments = std::make_shared<LinesArguments>();
    Command* command = app.add_subcommand("lines", "Draws a mesh or an animation in lines");
    command->footer(
        "SVG is made on the CPU: hidden lines are not in the file, each type of lines is a layer, and frames of an\n"
        "animation (--frames) play. Pictures (.png, or a folder: one a frame) and videos (.mp4, by ffmpeg) are drawn "
        "on\n"
        "the Vulkan device.\n\nExamples:\n"
        "  exemplar lines bunny.off --out bunny.svg\n"
        "  exemplar lines part.obj --types contours,creases,boundaries --style technical --view top --out part.svg\n"
        "  exemplar lines cow.off --labels cow_labels.txt --materials inks.json --out cow.svg\n"
        "  exemplar lines figure.glb --model figure.safetensors --frames 0:40 --style pencil --out walk.mp4\n"
        "  exemplar lines figure.glb --model figure.safetensors --frames 40: --compare --out unseen");
    LinesJob& job = arguments->job;
    command->add_option("INPUT", job.source.input, k_surface_argument)->type_name("");
    command->add_option("--out", job.out, "what to write: .svg, .png, .mp4, or a folder for a picture of each frame")
        ->type_name("FILE|FOLDER");
    add_look_options(*command, *arguments);
    add_camera_options(*command, job.camera);
    add_svg_options(*command, *arguments);
    command
        ->add_option("--model", job.source.model,
                     "takes curvature from this model of 'exemplar curvature train' instead of measuring it")
        ->type_name("FILE");
    command->add_flag("--compare", job.compare,
                      "draws each frame twice, by the curvature of --model on the left and by measured on the right, "
                      "and prints the share of faces that carry a line by one but not by the other");
    command->add_flag("--check", job.check,
                      "prints the share of the surface's silhouette that has a line, and of contours that are on no "
                      "edge of it");
    add_frame_options(*command, job.source.frames, "", "draw");
    command->add_option("--fps", job.source.frames_per_second, k_fps_option)
        ->capture_default_str()
        ->check(in_range(0.1, 1000.0));
    add_device_option(*command, job.common);
    add_common_options(*command, job.common);
    command->callback([arguments] { run_lines(*arguments); });
}

}  // namespace exemplar
