// exemplar lines: drawings as pictures, folders of pictures and videos, drawn on the device.

#include <fmt/format.h>

#include <functional>
#include <future>
#include <optional>
#include <utility>

#include "apps/exemplar/lines/frame_drawer.h"
#include "apps/exemplar/lines/lines_comparison.h"
#include "apps/exemplar/lines/lines_job.h"
#include "apps/exemplar/video.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

using DrawFrame = std::function<Image(std::size_t)>;

/// Calls use(image, number of the frame) for all frames, one after the other, in a thread of its own: while the device
/// draws a frame, the last one is compressed and written.
void draw_frames(const DrawFrame& draw, std::size_t count, const std::function<void(const Image&, std::size_t)>& use) {
    Progress progress = count > 1 ? Progress("drawing", count) : Progress();
    std::future<void> last;  // its destructor waits
    for (std::size_t frame = 0; frame < count; ++frame) {
        check_interrupt();
        Image image = draw(frame);
        if (last.valid()) last.get();
        last = std::async(std::launch::async, [&use, frame, image = std::move(image)] { use(image, frame); });
        progress.advance();
    }
    if (last.valid()) last.get();
}

void write_video(const LinesJob& job, LinesSource& source, const DrawFrame& draw, int width, int height) {
    if (!job.style.background)
        throw UsageError(
            fmt::format("{}: videos have no transparency; give a style with a background", job.out.string()));
    Video video(job.out, width, height, source.frames_per_second());
    draw_frames(draw, source.frame_count(), [&](const Image& image, std::size_t) { video.add(image); });
    video.finish();
}

void write_frames(const LinesJob& job, LinesSource& source, const DrawFrame& draw) {
    fs::create_directories(job.out);
    draw_frames(draw, source.frame_count(), [&](const Image& image, std::size_t frame) {
        write_png(job.out / fmt::format("frame_{:04}.png", frame), image);
    });
}

}  // namespace

void write_lines_pictures(const LinesJob& job) {
    Stopwatch watch;
    LinesSource source(job.source);
    if (job.compare && source.model()->truth.robust != RobustEstimator::none)
        throw UsageError(
            fmt::format("{}: was trained with --robust, and the device does not measure curvature so; --compare needs "
                        "a model trained without, or use 'exemplar curvature evaluate'",
                        job.source.model.string()));
    const StrokeView view = view_of(job.camera, source);
    if (job.output == LinesOutput::picture && source.frame_count() > 1)
        throw UsageError(fmt::format("{}: {} frames are no single picture; give a folder or one frame (--frames 0)",
                                     job.out.string(), source.frame_count()));
    FrameDrawer drawer(job, source, view);
    std::optional<LinesComparison> comparison;
    if (job.compare) comparison.emplace(job, source, drawer);
    OutlineCheck outline;
    const DrawFrame draw = [&](std::size_t frame) {
        Image image = comparison ? comparison->draw(frame) : drawer.draw(frame);
        if (job.check) outline.add(drawer.check_outline_of(frame));
        return image;
    };
    const int width = job.compare ? 2 * view.width : view.width;
    const double prepared = watch.wall();
    watch = {};
    switch (job.output) {
        case LinesOutput::picture:
            write_png(job.out, draw(0));
            break;
        case LinesOutput::video:
            write_video(job, source, draw, width, view.height);
            break;
        default:
            write_frames(job, source, draw);
    }
    if (!job.common.quiet)
        fmt::print("{}: {} of {} x {}, drawn on {}\n", job.out.string(), counted(source.frame_count(), "frame"), width,
                   view.height, drawer.device_name());
    if (const std::size_t dropped = drawer.dropped_segments(); dropped > 0 && !job.common.quiet)
        fmt::print(stderr,
                   "warning: {}: in the worst frame {} of lines had no room on the device and are left out; draw fewer "
                   "--types, raise thresholds, or write an SVG file\n",
                   job.out.string(), counted(dropped, "piece"));
    nlohmann::json report = describe_job(job, source, view);
    if (source.frame_count() > 1 && !comparison) {
        const LineFlicker flicker = drawer.flicker();
        report["flicker"] = {{"appeared", flicker.appeared}, {"slip", flicker.slip}, {"stretch", flicker.stretch}};
        if (!job.common.quiet)
            fmt::print(
                "from a frame to the next {:.1f} % of the length of lines is new, and textures slip by {:.1f} "
                "pixels\n",
                100 * flicker.appeared, flicker.slip);
    }
    if (job.check) report["outline"] = report_outline(job, outline);
    if (comparison) {
        comparison->print();
        report["comparison"] = comparison->describe();
    }
    report["device"] = drawer.device_name();
    report["seconds"] = {{"prepare", prepared}, {"draw", watch.wall()}};
    write_report(job.common, report);
}

}  // namespace exemplar
