// exemplar-viewer --headless: the frames of the window, without one.

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

#include "apps/viewer/scene/frame_renderer.h"
#include "apps/viewer/scene/options.h"
#include "apps/viewer/window/paint_script.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

// Returns the memory of this process without mapped files, which vary with the system's cache; 0 if there is no
// /proc.
std::size_t own_memory() {
    std::ifstream file("/proc/self/statm");
    std::size_t total = 0, resident = 0, shared = 0;
    file >> total >> resident >> shared;
    return (resident - std::min(resident, shared)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// Frames after which pools, caches and compiled kernels should no longer grow.
constexpr std::size_t k_warm_frames = 50;

void draw_frames(ViewerState& state, FrameRenderer& renderer, const ViewerOptions& options) {
    const std::size_t frames = std::max<std::size_t>(options.frames, 1);
    const Stopwatch watch;
    std::size_t warm_memory = 0;
    double first_frame = 0;
    Progress progress("drawing", frames);
    for (std::size_t i = 0; i < frames; ++i) {
        check_interrupt();
        if (i == k_warm_frames) warm_memory = own_memory();
        const std::size_t count = std::max<std::size_t>(state.playback.frame_count(), 1);
        state.playback.scrub((options.first_frame.value_or(0) + i) % count);
        renderer.follow(state);
        renderer.record(state, options.size);
        renderer.stream().submit();
        renderer.finish(state.times);
        if (i == 0) first_frame = watch.wall();
        if (!options.out.empty()) write_png(options.out / fmt::format("frame_{:04d}.png", i), renderer.read());
        progress.advance();
    }
    progress.finish();
    if (options.quiet) return;
    fmt::print("{} of {} x {} on {}: {:.2f} ms each, the first after {:.0f} ms\n", counted(frames, "frame"),
               options.size.width, options.size.height, renderer.device().info().name,
               frames > 1 ? 1e3 * (watch.wall() - first_frame) / static_cast<double>(frames - 1) : 1e3 * first_frame,
               1e3 * first_frame);
    for (const std::string& name : state.times.names())
        fmt::print("  {:<40} {:8.3f} ms\n", name, state.times.average(name));
    if (frames > k_warm_frames)
        fmt::print("memory: {:.1f} MiB after {} frames, {:.1f} MiB after {}\n",
                   static_cast<double>(warm_memory) / 1048576, k_warm_frames,
                   static_cast<double>(own_memory()) / 1048576, frames);
}

void save_still(const ViewerState& state, const ViewerOptions& options) {
    const HatchedStill still = hatched_still(state, options.size, options.device);
    const Stopwatch watch;
    const HatchedDrawing drawing = draw_still(still, [](const char*) { check_interrupt(); });
    write_still(options.hatched_still, still, drawing);
    if (!options.quiet)
        fmt::print("{}: {} in {}\n", options.hatched_still.string(), counted(drawing.strokes.size(), "stroke"),
                   format_seconds(watch.wall()));
}

}  // namespace

void run_headless(const ViewerOptions& options) {
    if (options.file.empty()) throw UsageError("--headless needs a FILE to draw");
    if (!options.out.empty()) std::filesystem::create_directories(options.out);
    ViewerState state;
    open_files(state, options, options.size);
    if (!state.has_document())
        throw UsageError(
            fmt::format("there is nothing to draw in {}; name a mesh or an animation as FILE", options.file.string()));
    if (!options.quiet)
        for (const Messages::Message& message : state.messages.all()) fmt::print(stderr, "warning: {}\n", message.text);
    if (!options.hatched_still.empty()) return save_still(state, options);
    std::shared_ptr<const ValidationLog> log;
    {
        Device device({.name = options.device});
        log = device.validation_log();
        FrameRenderer renderer(device);
        if (options.script.empty())
            draw_frames(state, renderer, options);
        else
            run_paint_script(options.script, state, renderer, options);
    }
    require_no_validation_messages(*log);
}

}  // namespace exemplar
