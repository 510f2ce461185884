#include "apps/exemplar/animation_arguments.h"

#include <fmt/format.h>

#include <charconv>

#include "apps/exemplar/arguments.h"
#include "host/animation/random_poses.h"
#include "host/animation/read_animation.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

/// One end of a range; `otherwise` where it is left out.
std::size_t range_end(std::string_view text, std::size_t otherwise, const std::string& range) {
    if (text.empty()) return otherwise;
    std::size_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size())
        throw UsageError(fmt::format("'{}' is no range of frames; write A:B, A: or :B, counting from 0", range));
    return value;
}

}  // namespace

void add_frame_options(Command& command, FrameArguments& arguments, const std::string& prefix,
                       const std::string& what) {
    command.add_option("--" + prefix + "clips", arguments.clips, "names of the clips to " + what + "; default: all")
        ->type_name("NAME")
        ->delimiter(',')
        ->allow_extra_args(false);
    command
        .add_option("--" + prefix + "frames", arguments.range,
                    "frames of each clip, from A up to but without B; or a single one")
        ->type_name("A:B");
    command.add_option("--" + prefix + "poses", arguments.most, "at most so many frames, evenly taken; 0 takes all")
        ->capture_default_str()
        ->check(whole_number(0));
}

FrameSelection selection_of(const FrameArguments& arguments) {
    FrameSelection selection{.clips = arguments.clips};
    if (arguments.most > 0) selection.most = arguments.most;
    if (arguments.range.empty()) return selection;
    const std::size_t colon = arguments.range.find(':');
    const std::string_view range = arguments.range;
    if (colon == std::string::npos) {
        selection.begin = range_end(range, 0, arguments.range);
        selection.end = selection.begin + 1;
        return selection;
    }
    selection.begin = range_end(range.substr(0, colon), 0, arguments.range);
    selection.end = range_end(range.substr(colon + 1), selection.end, arguments.range);
    if (selection.begin >= selection.end)
        throw UsageError(fmt::format("the range of frames '{}' is empty", arguments.range));
    return selection;
}

Animation animation_of_argument(const std::filesystem::path& path, double frames_per_second, std::uint64_t seed,
                                bool quiet) {
    constexpr std::size_t k_random_poses = 300;
    require_input(path);
    Animation animation = read_animation(path, {.frames_per_second = frames_per_second});
    if (animation.clips.empty() && animation.kind == AnimationKind::blend_shapes) {
        animation.clips.push_back(random_expressions(animation.rig, k_random_poses, seed));
        animation.warnings.push_back(fmt::format("{} has no clip: {} random expressions are taken, as clip '{}'",
                                                 animation.name, k_random_poses, animation.clips.back().name));
    }
    if (!quiet)
        for (const std::string& warning : animation.warnings) fmt::print(stderr, "warning: {}\n", warning);
    return animation;
}

}  // namespace exemplar
