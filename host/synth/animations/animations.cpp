#include "host/synth/animations/animations.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/synth/animations/cloth_scenes.h"
#include "host/synth/animations/face.h"
#include "host/synth/animations/figure.h"

namespace exemplar {
namespace {

constexpr std::size_t k_min_vertices = 500, k_max_vertices = 100'000, k_max_frames = 100'000;

struct AnimationGenerator {
    std::string_view name;
    Animation (*make)(const AnimationOptions&);
};

constexpr std::array<AnimationGenerator, 5> k_kinds{{{"figure", make_figure},
                                                     {"flag", make_flag},
                                                     {"curtain", make_curtain},
                                                     {"drape", make_drape},
                                                     {"face", make_face}}};

constexpr auto k_animation_names = [] {
    std::array<std::string_view, k_kinds.size()> names;
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = k_kinds[i].name;
    return names;
}();

const AnimationGenerator& find_animation_kind(std::string_view name) {
    for (const AnimationGenerator& kind : k_kinds)
        if (kind.name == name) return kind;
    const std::vector<std::string> names(k_animation_names.begin(), k_animation_names.end());
    throw UsageError(fmt::format("unknown animation kind '{}'{}; the kinds are {}", name, suggestion(name, names),
                                 fmt::join(names, ", ")));
}

void require_range(std::string_view what, std::size_t count, std::size_t low, std::size_t high) {
    if (count < low || count > high)
        throw UsageError(fmt::format("an animation of {} {} cannot be made; ask for {} to {}", count, what, low, high));
}

}  // namespace

std::span<const std::string_view> synth_animation_kinds() {
    return k_animation_names;
}

Animation make_animation(std::string_view kind_name, const AnimationOptions& options) {
    const AnimationGenerator& kind = find_animation_kind(kind_name);
    require_range("vertices", options.vertices, k_min_vertices, k_max_vertices);
    require_range("frames", options.frames, 1, k_max_frames);
    Animation animation = kind.make(options);
    animation.name = kind_name;
    animation.rest.source_face_count = static_cast<std::uint32_t>(animation.rest.face_count());
    animation.vertex_of_source.resize(animation.rest.vertex_count());
    std::iota(animation.vertex_of_source.begin(), animation.vertex_of_source.end(), 0U);
    animation.clips.front().name = fmt::format("motion_{}", options.motion_seed);
    return animation;
}

}  // namespace exemplar
