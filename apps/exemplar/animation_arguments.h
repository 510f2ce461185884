#pragma once

#include <filesystem>
#include <string>

#include "apps/exemplar/commands.h"
#include "apps/help/command.h"
#include "host/animation/animation.h"
#include "host/curvature/state/samples.h"

namespace exemplar {

/// The frames of an animation that a command works on.
struct FrameArguments {
    std::vector<std::string> clips;
    std::string range;     ///< "a:b", either end may be left out
    std::size_t most = 0;  ///< maximum number of frames; 0: all
};

/// Adds --clips, --frames and --poses. `prefix` goes before each name, as in --test-clips.
void add_frame_options(Command& command, FrameArguments& arguments, const std::string& prefix, const std::string& what);
/// Parses the arguments; throws UsageError for a bad range.
FrameSelection selection_of(const FrameArguments& arguments);

/// Reads an animation and prints its warnings unless `quiet`. Blend shapes without a clip get one of random
/// expressions, drawn from `seed`.
Animation animation_of_argument(const std::filesystem::path& path, double frames_per_second, std::uint64_t seed,
                                bool quiet);

}  // namespace exemplar
