// exemplar bench outlines: whether drawings of meshes in any condition show the whole outline.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "apps/help/command.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/lines/extraction/drawable_surface.h"
#include "host/lines/outline_check.h"
#include "host/lines/strokes/view_point.h"
#include "host/mesh/editing/drawable_mesh.h"
#include "host/mesh/io/io.h"
#include "host/synth/damage/damage.h"
#include "host/synth/shapes/shapes.h"

namespace exemplar {
namespace {

constexpr std::array k_outline_views = {"three-quarter", "front", "side", "top"};
constexpr std::array k_outline_types = {LineType::suggestive_contours, LineType::boundaries, LineType::contours};
constexpr std::size_t k_outline_faces = 4000;  // of a generated shape
constexpr double k_complete_share = 0.95;      // of the silhouette

struct OutlineBenchOptions {
    CommonOptions common;
    std::vector<std::filesystem::path> meshes;
};

/// A row of the table: some meshes, each from all views.
struct OutlineRow {
    std::string name;
    std::size_t drawings = 0, complete = 0;
    double worst = 1;  // share of the silhouette that has a line
    OutlineCheck check;
};

void add_drawings(const TriangleMesh& mesh, OutlineRow& row) {
    const DrawableMesh drawable = drawable_mesh(mesh, row.name);
    const std::vector<Vec3>& vertices = drawable.mesh.vertices;
    DrawableSurface surface(drawable.mesh.faces, vertices, {});
    surface.measure(vertices);
    const float unit = feature_size(surface.surface().vertices, surface.surface().curvature);
    const DrawingStyle style = load_style("ink");
    for (const char* view : k_outline_views) {
        check_interrupt();
        ViewPoint point;
        point.view = view;
        const StrokeView seen = stroke_view(point, drawable.mesh, unit);
        const Drawing drawing = draw_lines(surface.surface(), k_outline_types, style, seen);
        const OutlineCheck check =
            check_outline(drawable.mesh, seen.camera, ink_of(drawing), ink_of(drawing, LineType::contours));
        ++row.drawings;
        row.complete += check.outlined_share() >= k_complete_share ? 1 : 0;
        row.worst = std::min(row.worst, check.outlined_share());
        row.check.add(check);
    }
}

void print_row(const OutlineRow& row) {
    fmt::print("{:<28}{:>9}{:>12.1f}{:>10.1f}{:>10.1f}{:>10.1f}\n", row.name, row.drawings,
               100 * static_cast<double>(row.complete) / static_cast<double>(row.drawings),
               100 * row.check.outlined_share(), 100 * row.worst, 100 * row.check.stray_share());
}

nlohmann::json describe_row(const OutlineRow& row) {
    return {{"name", row.name},
            {"drawings", row.drawings},
            {"complete", row.complete},
            {"outlined", row.check.outlined_share()},
            {"worst_outlined", row.worst},
            {"stray", row.check.stray_share()}};
}

/// All kinds of generated shapes with one damage.
OutlineRow row_of_damage(const Damage& damage) {
    OutlineRow row{.name = std::string(damage.name), .check = {}};
    for (const std::string_view kind : synth_kinds())
        add_drawings(damage.apply(make_shape(kind, 1, k_outline_faces).mesh, 1).mesh, row);
    return row;
}

void run_outline_bench(const OutlineBenchOptions& options) {
    const auto limits = apply_common_options(options.common);
    std::vector<OutlineRow> rows;
    const auto add = [&](OutlineRow row) {
        print_row(row);
        rows.push_back(std::move(row));
    };
    fmt::print("{:<28}{:>9}{:>12}{:>10}{:>10}{:>10}\n", "%", "drawings", "95 % or more", "outlined", "worst", "stray");
    if (options.meshes.empty()) {
        for (const Damage& damage : damages()) add(row_of_damage(damage));
    } else {
        for (const std::filesystem::path& path : meshes_of_arguments(options.meshes)) {
            OutlineRow row{.name = path.filename().string(), .check = {}};
            add_drawings(read_mesh(path).mesh, row);
            add(std::move(row));
        }
    }
    OutlineRow all{.name = "all", .check = {}};
    nlohmann::json described = nlohmann::json::array();
    for (const OutlineRow& row : rows) {
        all.drawings += row.drawings;
        all.complete += row.complete;
        all.worst = std::min(all.worst, row.worst);
        all.check.add(row.check);
        described.push_back(describe_row(row));
    }
    if (all.drawings > 0) print_row(all);
    write_report(options.common, {{"rows", described}, {"all", describe_row(all)}});
}

}  // namespace

void add_bench_outlines_command(Command& bench) {
    auto options = std::make_shared<OutlineBenchOptions>();
    Command* command = bench.add_subcommand("outlines", "Measures whether line drawings show the whole outline");
    command->footer(
        "Draws meshes from four sides, and compares with the surface as a z-buffer shows it. Columns: drawings with "
        "a\n"
        "line at 95 % or more of the pixels of their silhouette; the share of all such pixels, and of the worst\n"
        "drawing; contours that are on no edge of the surface. Without meshes: all kinds of generated shapes, whole "
        "and\n"
        "with each damage of 'exemplar label stress'.\n\n"
        "Example:\n"
        "  exemplar bench outlines scans/");
    command->add_option("MESHES", options->meshes, "meshes, or folders of them; default: generated shapes")
        ->type_name("");
    add_common_options(*command, options->common);
    command->callback([options] { run_outline_bench(*options); });
}

}  // namespace exemplar
