#include "gpu/lines/strokes.h"

#include <fmt/format.h>

#include <cstddef>

#include "embedded/lines_strokes_comp.h"
#include "embedded/lines_visibility_comp.h"
#include "gpu/imaging/picture.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

using shared::LineCounts;
using shared::StrokeLook;
using shared::StrokeParameters;
using shared::uvec4;
using shared::vec4;

static_assert(shared::k_min_smoothing_window == k_min_smoothing_window &&
              shared::k_max_smoothing_window == k_max_smoothing_window &&
              shared::k_smoothing_window_points == k_smoothing_window_points &&
              shared::k_smoothing_window_reach == k_smoothing_window_reach);

StrokeParameters stroke_parameters(const StrokeView& view, bool curved, bool closed, bool inked) {
    const Eigen::Matrix4f& m = view.camera.projection;
    const bool parallel = is_parallel(view.camera);
    const auto toward = view.camera.view.row(2);
    return {.eye = homogeneous_eye(view.camera),
            .axis = {-toward[0], -toward[1], -toward[2], -toward[3]},
            .width = static_cast<std::uint32_t>(view.width),
            .height = static_cast<std::uint32_t>(view.height),
            .near_term = parallel ? m(2, 3) / m(2, 2) : -m(2, 3),
            .far_term = parallel ? -1 / m(2, 2) : -m(2, 2),
            .feature_size = view.feature_size,
            .unit_depth = view.unit_depth,
            .parallel = parallel ? 1u : 0u,
            .curved = curved ? 1u : 0u,
            .closed = closed ? 1u : 0u,
            .inked = inked ? 1u : 0u};
}

}  // namespace

StrokeLooks plain_looks(const LineThresholds& thresholds, const StrokeThickness& thickness) {
    StrokeLooks looks;
    for (std::uint32_t family = 0; family < shared::k_line_families; ++family) {
        const std::optional<LineFading> fading = line_fading(type_of_family(family), thresholds);
        looks[family] = {.color = {0, 0, 0, 1},
                         .width = thickness.width,
                         .epsilon = thickness.epsilon,
                         .least = thickness.least,
                         .most = thickness.most,
                         .taper = thickness.taper,
                         .threshold = fading ? fading->threshold : 0,
                         .fade = fading ? fading->half : 0,
                         .texture = 0,
                         .period = float(shared::k_texture_width)};
    }
    return looks;
}

GpuPartInks::GpuPartInks(const GpuSurface& surface, const PartInks& inks) {
    if (inks.ink_of_face.size() != surface.face_count())
        throw UsageError(
            fmt::format("{} inks for {} faces; give one per face", inks.ink_of_face.size(), surface.face_count()));
    std::vector<vec4> looks;
    looks.reserve(inks.inks.size());
    for (const PartInk& ink : inks.inks) {
        const Color color = ink.color.value_or(Color{});
        looks.push_back({ink.color ? static_cast<float>(color[0]) / 255 : -1, static_cast<float>(color[1]) / 255,
                         static_cast<float>(color[2]) / 255, ink.width});
    }
    of_faces_ = Buffer::of<std::uint32_t>(surface.device(), inks.ink_of_face);
    inks_ = Buffer::of<vec4>(surface.device(), looks);
}

GpuStrokes::GpuStrokes(const GpuChains& chains) : chains_(chains) {
    Device& device = chains.lines().surface().surface().device();
    const std::size_t room = 2 * chains.lines().room();
    visibility_kernel_ = Kernel(
        device, shaders::lines_visibility_comp,
        {.push_constants = layout_of<StrokeParameters>(),
         .elements = {layout_of<float>(), layout_of<uvec4>(), layout_of<uvec4>(), layout_of<uvec4>(), layout_of<vec4>(),
                      layout_of<vec4>(), layout_of<vec4>(), layout_of<uvec4>(), layout_of<vec4>()}});
    stroke_kernel_ =
        Kernel(device, shaders::lines_strokes_comp,
               {.push_constants = layout_of<StrokeParameters>(),
                .elements = {layout_of<uvec4>(), layout_of<std::uint32_t>(), layout_of<uvec4>(), layout_of<uvec4>(),
                             layout_of<vec4>(), layout_of<vec4>(), layout_of<vec4>(), layout_of<uvec4>(),
                             layout_of<std::uint32_t>(), layout_of<std::uint32_t>(), layout_of<std::uint32_t>()}});
    visible_ = Buffer(device, 2 * room * sizeof(std::uint32_t));
    strokes_ = Buffer(device, 2 * room * sizeof(vec4));
    looks_ = Buffer(device, sizeof(StrokeLooks));
}

void GpuStrokes::record(Stream& stream, const GpuCurvedSurface& snapshot, const Buffer& depths, const StrokeView& view,
                        const StrokeLooks& looks, const GpuPartInks* inks) {
    const std::size_t wanted = std::size_t{4} * static_cast<std::size_t>(view.width) * view.height;
    if (depths.bytes() < wanted)
        throw UsageError(fmt::format("depths of {} bytes for a picture of {} x {}; give a float per pixel",
                                     depths.bytes(), view.width, view.height));
    const GpuLineExtraction& lines = chains_.lines();
    const Buffer& counts = lines.counts();
    constexpr std::size_t k_points = offsetof(LineCounts, point_groups);
    stream.upload(looks_, std::span<const StrokeLook>(looks));
    const bool curved = snapshot.first && snapshot.second;
    const StrokeParameters parameters = stroke_parameters(view, curved, lines.surface().is_closed(), inks != nullptr);
    const Buffer &faces = lines.surface().surface().faces(), &first = curved ? *snapshot.first : snapshot.vertices,
                 &second = curved ? *snapshot.second : snapshot.vertices;
    stream.dispatch_indirect(
        visibility_kernel_, counts, k_points,
        {BufferRange(depths, 0, wanted), chains_.points(), lines.segments(), faces, snapshot.vertices, first, second,
         lines.surface().neighbors(), snapshot.normals, counts, visible_},
        parameters);
    stream.dispatch_indirect(stroke_kernel_, counts, k_points,
                             {chains_.points(), visible_, lines.segments(), faces, snapshot.vertices, first, second,
                              lines.surface().neighbors(), inks ? inks->of_faces() : faces, chains_.point_counts(),
                              chains_.point_groups(), counts, looks_, strokes_, inks ? inks->inks() : looks_},
                             parameters);
}

}  // namespace exemplar
