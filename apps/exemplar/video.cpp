#include "apps/exemplar/video.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <utility>

#include "host/core/errors.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& word) {
    std::string result = "'";
    for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

}  // namespace

void require_ffmpeg(const fs::path& path) {
    if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0)
        throw UsageError(fmt::format(
            "{}: videos are made by ffmpeg, which is not installed; install it, or give a folder", path.string()));
}

Video::Video(const fs::path& path, int width, int height, double frames_per_second)
    : path_(path), part_(path.parent_path() / (".part-" + std::to_string(getpid()) + path.filename().string())) {
    require_ffmpeg(path);
    if (path.has_parent_path()) fs::create_directories(path.parent_path());
    // If ffmpeg ends early, writing to it must fail rather than end this program.
    std::signal(SIGPIPE, SIG_IGN);
    // Most players want even sizes.
    const std::string command = fmt::format(
        "ffmpeg -loglevel error -nostdin -y -f rawvideo -pixel_format rgb24 -video_size {}x{} -framerate {} -i - "
        "-vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white' -pix_fmt yuv420p {} >&2",
        width, height, frames_per_second, quoted(fs::absolute(part_).string()));
    pipe_ = popen(command.c_str(), "w");
    if (!pipe_) throw DataError(fmt::format("{}: ffmpeg cannot be started", path.string()));
}

Video::~Video() {
    if (!pipe_) return;
    pclose(pipe_);
    std::error_code ignored;
    fs::remove(part_, ignored);
}

void Video::add(const Image& image) {
    if (std::fwrite(image.data.data(), 1, image.data.size(), pipe_) != image.data.size())
        throw DataError(fmt::format("{}: ffmpeg takes no more frames; is the disk full?", path_.string()));
}

void Video::finish() {
    const int status = pclose(std::exchange(pipe_, nullptr));
    if (status != 0) {
        std::error_code ignored;
        fs::remove(part_, ignored);
        throw DataError(fmt::format("{}: ffmpeg has failed; try a name that ends in .mp4", path_.string()));
    }
    fs::rename(part_, path_);
}

}  // namespace exemplar
