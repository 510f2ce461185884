#pragma once

#include <cstdio>
#include <filesystem>

#include "host/imaging/image.h"

namespace exemplar {

/// Throws UsageError if there is no ffmpeg to make a video at `path`.
void require_ffmpeg(const std::filesystem::path& path);

/// A video that ffmpeg, a program that must be installed, makes of frames; beside its place until it is whole.
class Video {
  public:
    /// Of frames of that size. Throws as require_ffmpeg, DataError if it cannot be started.
    Video(const std::filesystem::path& path, int width, int height, double frames_per_second);
    /// Removes what was not finished.
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
