// exemplar lines: drawings as SVG, with exact hidden-line removal on the host.

#include <fmt/format.h>

#include "apps/exemplar/lines/lines_job.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

/// Counts of one type over all frames.
struct TypeSummary {
    std::size_t segments = 0, strokes = 0, runs = 0;
    double length = 0;  ///< visible, in pixels
};

TypeSummary summarize_type(std::span<const Drawing> drawings, LineType type) {
    TypeSummary summary;
    for (const Drawing& drawing : drawings)
        for (const DrawingLayer& layer : drawing.layers) {
            if (layer.type != type) continue;
            summary.segments += layer.segments;
            summary.strokes += layer.strokes.size();
            for (const Stroke& stroke : layer.strokes)
                for (const StrokeRun& run : visible_runs(stroke)) {
                    ++summary.runs;
                    summary.length += static_cast<double>(length_of(run));
                }
        }
    return summary;
}

nlohmann::json describe_types(const LinesJob& job, std::span<const Drawing> drawings) {
    nlohmann::json types = nlohmann::json::object();
    for (const LineType type : job.types) {
        const TypeSummary summary = summarize_type(drawings, type);
        types[std::string(name_of(type))] = {{"segments", summary.segments},
                                             {"chains", summary.strokes},
                                             {"visible_runs", summary.runs},
                                             {"visible_pixels", summary.length}};
    }
    return types;
}

OutlineCheck check_drawing(const Drawing& drawing, const LinesSource& source, std::size_t frame, const Camera& camera) {
    return check_outline(source.mesh(frame), camera, ink_of(drawing), ink_of(drawing, LineType::contours));
}

}  // namespace

void write_lines_svg(const LinesJob& job) {
    Stopwatch watch;
    LinesSource source(job.source);
    const double read = watch.wall();
    watch = {};
    const StrokeView view = view_of(job.camera, source);
    double curvature = watch.wall();
    std::vector<Drawing> drawings;
    Drawing::Seconds seconds;
    OutlineCheck outline;
    const std::size_t count = source.frame_count();
    Progress progress = count > 1 ? Progress("drawing", count) : Progress();
    for (std::size_t frame = 0; frame < count; ++frame) {
        check_interrupt();
        watch = {};
        const LineSurface surface = source.surface(frame);
        curvature += watch.wall();
        drawings.push_back(draw_lines(surface, job.types, job.style, view));
        if (job.check) outline.add(check_drawing(drawings.back(), source, frame, view.camera));
        seconds.lines += drawings.back().seconds.lines;
        seconds.visibility += drawings.back().seconds.visibility;
        seconds.strokes += drawings.back().seconds.strokes;
        progress.advance();
    }
    progress.finish();
    watch = {};
    SvgOptions options = job.svg;
    options.frames_per_second = source.frames_per_second();
    options.title = job.source.input.stem().string();
    const SvgSummary summary = write_drawing_svg(job.out, drawings, job.style, options, source.inks());
    if (!job.common.quiet)
        fmt::print("{}: {} of {}, {:.0f} pixels long\n", job.out.string(), counted(summary.paths, "path"),
                   counted(drawings.size(), "frame"), summary.length);
    nlohmann::json report = describe_job(job, source, view);
    if (job.check) report["outline"] = report_outline(job, outline);
    report["types"] = describe_types(job, drawings);
    report["paths"] = summary.paths;
    report["points"] = summary.points;
    report["bytes"] = std::filesystem::file_size(job.out);
    report["seconds"] = {{"read", read},
                         {"curvature", curvature},
                         {"lines", seconds.lines},
                         {"visibility", seconds.visibility},
                         {"strokes", seconds.strokes},
                         {"write", watch.wall()}};
    write_report(job.common, report);
}

}  // namespace exemplar
