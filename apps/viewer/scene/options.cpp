#include "apps/viewer/scene/options.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/runtime/vulkan/errors.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

void choose_clip(ViewerState& state, const std::string& name) {
    std::vector<std::string> names;
    for (const Clip& clip : state.document().animation.clips) names.push_back(clip.name);
    const auto place = std::ranges::find(names, name);
    if (place == names.end())
        throw UsageError(
            fmt::format("{} has no clip '{}'{}", state.document().animation.name, name, suggestion(name, names)));
    state.set_clip(static_cast<std::size_t>(place - names.begin()));
}

}  // namespace

void apply_options(ViewerState& state, const ViewerOptions& options, ViewSize view) {
    if (!options.style.empty()) state.settings.set_style(load_style(options.style));
    if (options.lines)
        for (std::size_t i = 0; i < k_line_types.size(); ++i)
            state.settings.lines[i] = std::ranges::find(*options.lines, k_line_types[i]) != options.lines->end();
    if (options.paint) state.settings.paint = *options.paint;
    if (options.light) state.settings.light = *options.light;
    if (options.source) state.settings.source = *options.source;
    if (options.side) state.camera.look_from(*options.side);
    state.camera.set_parallel(options.parallel);
    state.fit(view);
    if (options.first_frame) state.playback.scrub(*options.first_frame);
}

void open_files(ViewerState& state, const ViewerOptions& options, ViewSize view) {
    if (options.label) {
        state.start_labeling(options.file, options.model, view);
    } else {
        if (!options.file.empty()) state.open(options.file, view);
        if (!options.model.empty()) state.open_model(options.model);
    }
    if (!options.hatching.empty()) state.open_hatching(options.hatching);
    if (!options.clip.empty()) {
        if (!state.has_document()) throw UsageError("--clip needs an animation; name its FILE");
        choose_clip(state, options.clip);
    }
    apply_options(state, options, view);
}

void require_no_validation_messages(const ValidationLog& log) {
    const std::vector<std::string> messages = log.messages();
    if (messages.empty()) return;
    std::string first = messages.front();
    std::ranges::replace(first, '\n', ' ');
    throw DeviceError(fmt::format("the validation layer complained {} times, first: {}", messages.size(), first));
}

}  // namespace exemplar
