#include "gpu/lines/coherence.h"

#include <cstddef>
#include <span>
#include <utility>

#include "embedded/lines_phases_comp.h"
#include "embedded/lines_traces_comp.h"
#include "embedded/lines_votes_comp.h"
#include "embedded/lines_write_traces_comp.h"
#include "gpu/imaging/picture.h"

namespace exemplar {
namespace {

using shared::ChainVotes;
using shared::FlickerSums;
using shared::FollowParameters;
using shared::LineCounts;
using shared::uvec4;
using shared::vec2;
using shared::vec4;

static_assert(shared::k_max_vote == k_max_vote && shared::k_follow_faces == k_follow_faces &&
              shared::k_follow_reach == k_follow_reach && shared::k_follow_points == k_follow_points &&
              shared::k_whole_chain_divisor == k_whole_chain_divisor);

FollowParameters follow_parameters(const StrokeView& view, bool keeps) {
    FollowParameters parameters{.matrix = {},
                                .width = static_cast<float>(view.width),
                                .height = static_cast<float>(view.height),
                                .keeps = keeps ? 1u : 0u};
    put_matrix(view.camera.view_projection(), parameters.matrix);
    return parameters;
}

}  // namespace

GpuCoherence::GpuCoherence(const GpuStrokes& strokes) : strokes_(strokes) {
    const GpuLineExtraction& lines = strokes.chains().lines();
    Device& device = lines.surface().surface().device();
    const std::size_t room = lines.room();
    const StructLayout word = layout_of<std::uint32_t>(), four = layout_of<vec4>(), words = layout_of<uvec4>();
    trace_kernel_ = Kernel(device, shaders::lines_traces_comp,
                           {.push_constants = layout_of<FollowParameters>(), .elements = {four, words, words, four}});
    vote_kernel_ = Kernel(device, shaders::lines_votes_comp,
                          {.elements = {words, words, words, words, four, word, word, words, four}});
    phase_kernel_ = Kernel(device, shaders::lines_phases_comp,
                           {.push_constants = layout_of<FollowParameters>(), .elements = {words, words}});
    trace_writing_kernel_ =
        Kernel(device, shaders::lines_write_traces_comp, {.elements = {words, word, four, words, layout_of<float>()}});
    traces_ = Buffer(device, room * sizeof(vec4));
    previous_traces_ = Buffer(device, room * sizeof(vec4));
    ends_ = Buffer(device, 2 * room * sizeof(vec4));
    votes_ = Buffer(device, room * sizeof(ChainVotes));
    matches_ = Buffer(device, 4 * room * sizeof(uvec4));
    phases_ = Buffer(device, 2 * room * sizeof(vec2));
    flicker_ = Buffer(device, sizeof(FlickerSums));
}

void GpuCoherence::record(Stream& stream, const Buffer& vertices, const StrokeView& view, bool keeps) {
    const GpuChains& chains = strokes_.chains();
    const GpuLineExtraction& lines = chains.lines();
    const GpuLineExtraction::Previous before = lines.previous();
    const GpuLineSurface& surface = lines.surface();
    const Buffer &counts = lines.counts(), &faces = surface.surface().faces();
    const FollowParameters parameters = follow_parameters(view, keeps);
    constexpr std::size_t k_traces = offsetof(LineCounts, trace_groups), k_points = offsetof(LineCounts, point_groups);
    std::swap(traces_, previous_traces_);
    stream.dispatch_indirect(trace_kernel_, counts, k_traces,
                             {vertices, faces, before.segments, previous_traces_, counts, ends_, votes_, flicker_},
                             parameters);
    stream.dispatch_indirect(
        vote_kernel_, counts, k_points,
        {chains.points(), lines.segments(), faces, surface.neighbors(), vertices, before.face_counts,
         before.face_groups, before.segments, ends_, counts, strokes_.looks(), votes_, matches_});
    stream.dispatch_indirect(phase_kernel_, counts, k_points, {chains.points(), matches_, counts, votes_, phases_},
                             parameters);
    stream.dispatch_indirect(
        trace_writing_kernel_, counts, k_points,
        {chains.points(), strokes_.visible(), strokes_.strokes(), matches_, phases_, counts, traces_, flicker_});
}

LineFlicker GpuCoherence::flicker() const {
    FlickerSums sums{};
    flicker_.download(std::span(&sums, 1));
    const auto share = [](std::uint32_t part, std::uint32_t of) {
        return of ? static_cast<float>(part) / static_cast<float>(of) : 0.0f;
    };
    return {.drawn = static_cast<float>(sums.drawn) / shared::k_flicker_unit,
            .appeared = share(sums.appeared, sums.drawn),
            .slip = share(sums.slip, sums.kept),
            .stretch = share(sums.stretch, sums.drawn)};
}

}  // namespace exemplar
