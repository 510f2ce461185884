// exemplar hatch compare: drawings of a view beside an artist's.

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/hatch/hatch_halves.h"
#include "apps/exemplar/hatch/hatch_reading.h"
#include "apps/exemplar/hatch/hatch_scene.h"
#include "host/core/errors.h"
#include "host/core/progress.h"
#include "host/hatching/comparison/drawing_comparison.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct CompareArguments {
    HatchSceneArguments scene;
    fs::path artist, mask, out;
    std::vector<fs::path> drawings;
    std::vector<std::size_t> pages;  // of the artist's drawing, then of the others
    bool halves = false;
    std::uint64_t seed = 1;
    CommonOptions common;
};

ComparedDrawing compared(AlignedDrawing drawing) {
    return {std::move(drawing.darkness), std::move(drawing.strokes)};
}

std::string percent(double share) {
    return fmt::format("{:.0f} %", 100 * share);
}

void print_comparison(const std::string& title, const DrawingComparison& c) {
    fmt::print("{}\n", title);
    fmt::print("  direction  {:.1f} degrees off in the median, {:.1f} in the mean; {:.1f} % more than 30 ({} pixels)\n",
               c.direction_median, c.direction_mean, 100 * c.direction_off, c.inked_by_both);
    fmt::print("  region     {:.2f} of what either hatches; {} of the object, the artist {}\n", c.region_overlap,
               percent(c.hatched[1]), percent(c.hatched[0]));
    fmt::print(
        "  tone       correlation {:.2f}, {:.2f}, {:.2f} over 1, 2, 4 spacings; mean darkness {:.3f}, the artist's "
        "{:.3f}\n",
        c.tone[0], c.tone[1], c.tone[2], c.ink[1], c.ink[0]);
    fmt::print("  levels     {:.1f} % right;", 100 * c.level_right);
    constexpr std::array<const char*, 3> k_levels{"none", "single", "crossed"};
    for (std::size_t a = 0; a < k_levels.size(); ++a)
        fmt::print(" {} as none {}, single {}, crossed {}{}", k_levels[a], percent(c.level[a][0]),
                   percent(c.level[a][1]), percent(c.level[a][2]), a + 1 < k_levels.size() ? ";" : "\n");
    for (const auto p : {StrokeProperty::thickness, StrokeProperty::spacing, StrokeProperty::length})
        fmt::print("  {:<10} {:.2f} of the artist's in the median; off by a factor of {:.2f}\n", name_of(p),
                   c.ratio[static_cast<std::size_t>(p)], c.factor[static_cast<std::size_t>(p)]);
}

nlohmann::json as_json(const std::string& title, const DrawingComparison& c) {
    return {{"drawing", title},
            {"inked_by_both", c.inked_by_both},
            {"direction_median", c.direction_median},
            {"direction_mean", c.direction_mean},
            {"direction_off", c.direction_off},
            {"region_overlap", c.region_overlap},
            {"hatched", c.hatched},
            {"tone", c.tone},
            {"ink", c.ink},
            {"level", c.level},
            {"level_right", c.level_right},
            {"property_ratio", c.ratio},
            {"property_factor", c.factor}};
}

/// Compares what is learned from halves of the drawing with the other halves.
nlohmann::json report_halves(const CompareArguments& arguments, HatchScene& scene, const ComparedDrawing& artist,
                             const PixelMask& mask) {
    Progress progress("learning from halves", 4);
    std::size_t done = 0;
    const std::vector<HalfComparison> halves = compare_halves(
        scene, artist, mask, arguments.seed, [&](const char* half) { progress.advance(done++ > 0 ? 1 : 0, half); });
    progress.advance(1);
    progress.finish();
    nlohmann::json report = nlohmann::json::array();
    double off = 0;
    for (const HalfComparison& half : halves) {
        const std::string title = fmt::format("learned from the {} half, compared in the other", half.learned_from);
        if (!arguments.common.quiet) print_comparison(title, half.comparison);
        report.push_back(as_json(half.learned_from, half.comparison));
        off += half.comparison.direction_off / static_cast<double>(halves.size());
    }
    if (!arguments.common.quiet)
        fmt::print("half to half: {:.1f} % of directions more than 30 degrees off\n", 100 * off);
    return report;
}

void run_compare(CompareArguments& arguments) {
    const auto limits = apply_common_options(arguments.common);
    if (arguments.drawings.empty() && !arguments.halves)
        throw UsageError("there is nothing to compare with the artist's drawing; name drawings, or give --halves");
    require_hatch_scene(arguments.scene);
    require_input(arguments.artist);
    if (!arguments.mask.empty()) require_input(arguments.mask);
    for (const fs::path& drawing : arguments.drawings) require_input(drawing);
    if (!arguments.out.empty()) require_output_folder(arguments.out);
    HatchScene scene(arguments.scene, arguments.common.device, arguments.common.quiet);
    const PixelFeatures& pixels = scene.pixels();
    PixelMask mask = compared_pixels(pixels.gbuffer(), view_outlines(pixels.gbuffer()));
    if (!arguments.mask.empty()) mask = read_mask(arguments.mask, pixels);
    const ComparedDrawing artist = compared(
        read_drawing({arguments.artist, page_of(arguments.pages, 0)}, arguments.scene, pixels, arguments.common.quiet));
    nlohmann::json report = nlohmann::json::array();
    for (std::size_t i = 0; i < arguments.drawings.size(); ++i) {
        const fs::path& path = arguments.drawings[i];
        const ComparedDrawing drawing =
            compared(read_drawing_in_place({path, page_of(arguments.pages, i + 1)}, pixels));
        const DrawingComparison comparison = compare_drawings(artist, drawing, mask);
        report.push_back(as_json(path.string(), comparison));
        if (!arguments.common.quiet) print_comparison(path.string(), comparison);
        if (arguments.out.empty()) continue;
        fs::create_directories(arguments.out);
        write_png(arguments.out / (path.stem().string() + "_compared.png"), comparison_picture(artist, drawing, mask));
    }
    if (arguments.halves) report.push_back({{"halves", report_halves(arguments, scene, artist, mask)}});
    write_report(arguments.common, report);
}

}  // namespace

void add_hatch_compare_command(Command& hatch) {
    auto arguments = std::make_shared<CompareArguments>();
    Command* command = hatch.add_subcommand("compare", "Compares drawings of a view with an artist's");
    command->footer(
        "Compares the direction of strokes, hatched region, tone, levels and stroke properties, away from the "
        "object's\n"
        "outlines. Of drawings by any hand or program: pictures are all it takes.\n\nExample:\n"
        "  exemplar hatch compare bunny.off traced.png drawn.png --view three-quarter --out compared");
    command->add_option("MESH", arguments->scene.mesh, "mesh that the drawings show")->required()->type_name("");
    command
        ->add_option("ARTIST", arguments->artist,
                     "the drawing to compare with (PNG, JPEG, TIFF or SVG); aligned with the view")
        ->required()
        ->type_name("");
    command->add_option("DRAWING", arguments->drawings, "drawings that show exactly the view (PNG, JPEG, TIFF or SVG)")
        ->type_name("...");
    add_page_option(*command, arguments->pages, "given several times");
    command->add_flag("--halves", arguments->halves,
                      "learn from each half of the artist's drawing, and compare what is predicted with the other");
    command->add_option("--seed", arguments->seed, "of learning with --halves")
        ->capture_default_str()
        ->check(whole_number(0));
    command
        ->add_option("--mask", arguments->mask,
                     "picture of the view, white where to compare (PNG, JPEG or TIFF); default: the object but for a "
                     "band of 3.5 "
                     "pixels along its outlines")
        ->type_name("FILE");
    command
        ->add_option("--out", arguments->out,
                     "folder for a picture of each: strokes green where they run like the artist's, red where "
                     "they are off by more than 30 degrees")
        ->type_name("FOLDER");
    add_template_option(*command, arguments->scene, add_hatch_scene_options(*command, arguments->scene));
    add_device_option(*command, arguments->common);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_compare(*arguments); });
}

}  // namespace exemplar
