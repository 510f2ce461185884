#pragma once

#include <cstdio>
#include <filesystem>

#include "host/imaging/image.h"

namespace exemplar {

/// Throws UsageError if there is no ffmpeg to make a video at `path`.
void require_ffmpeg(const std::filesystem::path& path);

/// Makes a video of frames with ffmpeg, a program that must be installed. Writes a temporary file until it is
/// complete.
class Video {
  public:
    /// Starts a video of that frame size. Throws as require_ffmpeg, DataError if ffmpeg cannot be started.
    Video(const std::filesystem::path& path, int width, int height, double frames_per_second);
    /// Removes an unfinished video.
    ~Video();
    Video(const Video&) = delete;
    Video& operator=(const Video&) = delete;

    /// Both throw DataError if ffmpeg fails.
    void add(const Image& image);
    void finish();

  private:
    std::filesystem::path path_, part_;
    std::FILE* pipe_ = nullptr;
};

}  // namespace exemplar
