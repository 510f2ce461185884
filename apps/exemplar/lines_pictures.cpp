// exemplar lines: drawings as pictures, folders of pictures and videos, drawn on the device.

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>

#include "apps/exemplar/frame_drawer.h"
#include "apps/exemplar/lines_comparison.h"
#include "apps/exemplar/lines_job.h"
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

std::string quoted(const std::string& word) {
    std::string result = "'";
    for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

/// A video that ffmpeg, a program that must be installed, makes of frames; beside its place until it is whole.
class Video {
  public:
    Video(const fs::path& path, int width, int height, double frames_per_second)
        : path_(path), part_(path.parent_path() / (".part-" + std::to_string(getpid()) + path.filename().string())) {
        if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0)
            throw UsageError(fmt::format(
                "{}: videos are made by ffmpeg, which is not installed; install it, or give a folder", path.string()));
        if (path.has_parent_path()) fs::create_directories(path.parent_path());
        // Most players want even sizes.
        const std::string command = fmt::format(
            "ffmpeg -loglevel error -nostdin -y -f rawvideo -pixel_format rgb24 -video_size {}x{} -framerate {} -i - "
            "-vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white' -pix_fmt yuv420p {} >&2",
            width, height, frames_per_second, quoted(fs::absolute(part_).string()));
        pipe_ = popen(command.c_str(), "w");
        if (!pipe_) throw DataError(fmt::format("{}: ffmpeg cannot be started", path.string()));
    }
    ~Video() {
        if (!pipe_) return;
        pclose(pipe_);
        std::error_code ignored;
        fs::remove(part_, ignored);
    }
    Video(const Video&) = delete;
    Video& operator=(const Video&) = delete;

    void add(const Image& image) {
        if (std::fwrite(image.data.data(), 1, image.data.size(), pipe_) != image.data.size())
            throw DataError(fmt::format("{}: ffmpeg takes no more frames; is the disk full?", path_.string()));
    }
    void finish() {
        const int status = pclose(std::exchange(pipe_, nullptr));
        if (status != 0) {
            std::error_code ignored;
            fs::remove(part_, ignored);
            throw DataError(fmt::format("{}: ffmpeg has failed; try a name that ends in .mp4", path_.string()));
        }
        fs::rename(part_, path_);
    }

  private:
    fs::path path_, part_;
    std::FILE* pipe_ = nullptr;
};

/// Calls use(image, number of the frame) for all frames.
void draw_frames(const DrawFrame& draw, std::size_t count, const std::function<void(const Image&, std::size_t)>& use) {
    Progress progress = count > 1 ? Progress("drawing", count) : Progress();
    for (std::size_t frame = 0; frame < count; ++frame) {
        check_interrupt();
        use(draw(frame), frame);
        progress.advance();
    }
}

void write_video(const LinesJob& job, LinesSource& source, const DrawFrame& draw, int width, int height) {
    if (!job.style.background)
        throw UsageError(
            fmt::format("{}: videos have no transparency; give a style with a background", job.out.string()));
    Video video(job.out, width, height, source.frames_per_second());
    draw_frames(draw, source.frame_count(), [&](const Image& image, std::size_t) { video.add(image); });
    video.finish();
}

void write_pictures(const LinesJob& job, LinesSource& source, const DrawFrame& draw) {
    fs::create_directories(job.out);
    draw_frames(draw, source.frame_count(), [&](const Image& image, std::size_t frame) {
        write_png(job.out / fmt::format("frame_{:04}.png", frame), image);
    });
}

}  // namespace

void write_lines_pictures(const LinesJob& job) {
    Stopwatch watch;
    LinesSource source(job.source);
    const StrokeView view = view_of(job.camera, source);
    if (job.output == LinesOutput::picture && source.frame_count() > 1)
        throw UsageError(fmt::format("{}: {} frames are no single picture; give a folder or one frame (--frames 0)",
                                     job.out.string(), source.frame_count()));
    FrameDrawer drawer(job, source, view);
    std::optional<LinesComparison> comparison;
    if (job.compare) comparison.emplace(job, source, drawer);
    const DrawFrame draw = [&](std::size_t frame) { return comparison ? comparison->draw(frame) : drawer.draw(frame); };
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
            write_pictures(job, source, draw);
    }
    if (!job.common.quiet)
        fmt::print("{}: {} of {} x {}, drawn on {}\n", job.out.string(), counted(source.frame_count(), "frame"), width,
                   view.height, drawer.device_name());
    nlohmann::json report = describe_job(job, source, view);
    if (comparison) {
        comparison->print();
        report["comparison"] = comparison->describe();
    }
    report["device"] = drawer.device_name();
    report["seconds"] = {{"prepare", prepared}, {"draw", watch.wall()}};
    write_report(job.common, report);
}

}  // namespace exemplar
