#include "gpu/lines/extraction.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "embedded/lines_apparent_ridges_comp.h"
#include "embedded/lines_count_comp.h"
#include "embedded/lines_fields_comp.h"
#include "embedded/lines_scan_comp.h"
#include "embedded/lines_segments_comp.h"
#include "embedded/lines_view_curvature_comp.h"
#include "gpu/curvature/surface/texels.h"
#include "host/core/errors.h"
#include "shaders/shared/lines.h"

namespace exemplar {
namespace {

using shared::FaceLineParameters;
using shared::FieldParameters;
using shared::uvec4;
using shared::vec4;

constexpr std::size_t k_max_segments = std::size_t{1} << shared::k_segment_bits;

std::size_t divide_up(std::size_t count, std::size_t size) {
    return (count + size - 1) / size;
}

FieldParameters field_parameters(const GpuLineOptions& options, std::uint32_t vertices) {
    const FamilyThresholds& t = options.thresholds;
    return {.eye = options.eye,
            .low_thresholds = {t[0], t[1], t[2], t[3]},
            .high_thresholds = {t[4], t[5], t[6], t[7]},
            .vertices = vertices,
            .feature_size = options.feature_size};
}

void check(const GpuCurvedSurface& snapshot, std::uint32_t families, const GpuLineOptions& options) {
    if (!(families & shared::k_curvature_families)) return;
    if (!snapshot.first || !snapshot.second || !snapshot.derivative)
        throw UsageError("these lines need curvature with derivatives; estimate or learn it");
    if (!(options.feature_size > 0 && std::isfinite(options.feature_size)))
        throw UsageError(fmt::format("a feature size of {}: give a positive length", options.feature_size));
}

}  // namespace

FamilyThresholds family_thresholds(const LineThresholds& thresholds) {
    FamilyThresholds result{};
    for (std::uint32_t family = 0; family < shared::k_line_families; ++family)
        if (const auto fading = line_fading(type_of_family(family), thresholds)) result[family] = fading->threshold;
    result[shared::k_creases] = thresholds.crease_angle;
    return result;
}

GpuLineExtraction::GpuLineExtraction(const GpuLineSurface& surface, std::size_t max_segments)
    : surface_(surface),
      room_(
          std::min({std::max<std::size_t>(surface.surface().face_count(), k_min_room), max_segments, k_max_segments})),
      scan_kernel_(surface.surface().device(), shaders::lines_scan_comp,
                   {.push_constants = layout_of<shared::ScanParameters>(), .constants = {{0, 0}}}) {
    Device& device = surface.surface().device();
    check_texels(device, 2 * room_, "the lines of a surface");
    const std::size_t faces = surface.surface().face_count();
    for (Buffer* buffer : {&face_counts_, &old_face_counts_, &face_slots_})
        *buffer = Buffer(device, faces * sizeof(std::uint32_t));
    for (Buffer* buffer : {&face_groups_, &old_face_groups_})
        *buffer = Buffer(device, divide_up(faces, shared::k_count_group) * sizeof(std::uint32_t));
    for (Buffer* buffer : {&segments_, &old_segments_})
        *buffer = Buffer(device, room_ * sizeof(shared::LineSegmentRecord));
    const shared::LineCounts none{};
    counts_ = Buffer::of(device, std::span(&none, 1));
}

// The families are a constant of the kernels, so that others cost nothing: D2 in docs/portability.md.
GpuLineExtraction::Kernels GpuLineExtraction::make_kernels(std::uint32_t families) const {
    Device& device = surface_.surface().device();
    const StructLayout word = layout_of<std::uint32_t>(), four = layout_of<vec4>(), words = layout_of<uvec4>();
    const auto kernel = [&](const Shader& shader, const StructLayout& push, std::vector<StructLayout> elements) {
        return Kernel(device, shader,
                      {.push_constants = push, .elements = std::move(elements), .constants = {{0, families}}});
    };
    const StructLayout field = layout_of<FieldParameters>(), face = layout_of<FaceLineParameters>();
    Kernels kernels;
    kernels.fields = kernel(shaders::lines_fields_comp, field, std::vector<StructLayout>(7, four));
    kernels.count = kernel(shaders::lines_count_comp, face, {four, words, words, four, four, words, word, word, word});
    kernels.segments =
        kernel(shaders::lines_segments_comp, face,
               {four, words, words, four, four, words, word, word, word, layout_of<shared::LineSegmentRecord>()});
    if (families & 1u << shared::k_apparent_ridges)
        kernels.ridges =
            kernel(shaders::lines_apparent_ridges_comp, field, {four, four, four, four, word, words, four, four});
    return kernels;
}

const GpuLineExtraction::Kernels& GpuLineExtraction::prepare(std::uint32_t families) {
    Device& device = surface_.surface().device();
    const std::size_t vertices = surface_.surface().vertex_count();
    const auto room_for = [&](std::uint32_t of) {
        const std::size_t texels = static_cast<std::size_t>(std::popcount(families & of)) * vertices;
        check_texels(device, texels, "the fields of lines");
        return texels * sizeof(vec4);
    };
    reserve(device, fields_, room_for(shared::k_field_families));
    reserve(device, directions_, room_for(shared::k_axis_families));
    const bool apparent = families & 1u << shared::k_apparent_ridges;
    reserve(device, views_, apparent ? vertices * sizeof(vec4) : 0);
    if (apparent && !view_kernel_)
        view_kernel_ =
            Kernel(device, shaders::lines_view_curvature_comp,
                   {.push_constants = layout_of<FieldParameters>(), .elements = std::vector(5, layout_of<vec4>())});
    auto known = kernels_.find(families);
    if (known == kernels_.end()) known = kernels_.emplace(families, make_kernels(families)).first;
    return known->second;
}

void GpuLineExtraction::record_fields(Stream& stream, const Kernels& kernels, const GpuCurvedSurface& snapshot,
                                      std::uint32_t families, const GpuLineOptions& options) {
    const GpuSurface& surface = surface_.surface();
    const std::uint32_t vertices = surface.vertex_count();
    const FieldParameters parameters = field_parameters(options, vertices);
    // All bindings need a buffer, even those that are not read.
    const Buffer &first = snapshot.first ? *snapshot.first : snapshot.vertices,
                 &second = snapshot.second ? *snapshot.second : snapshot.vertices,
                 &derivative = snapshot.derivative ? *snapshot.derivative : snapshot.vertices;
    const std::uint32_t apparent = 1u << shared::k_apparent_ridges;
    if (families & shared::k_field_families & ~apparent)
        stream.dispatch(kernels.fields, vertices,
                        {snapshot.vertices, snapshot.normals, first, second, derivative, fields_, directions_},
                        parameters);
    if (!(families & apparent)) return;
    stream.dispatch(view_kernel_, vertices, {snapshot.vertices, snapshot.normals, first, second, views_}, parameters);
    stream.dispatch(
        kernels.ridges, vertices,
        {snapshot.vertices, first, second, views_, surface.ring_begin(), surface.rings(), fields_, directions_},
        parameters);
}

void GpuLineExtraction::record(Stream& stream, const GpuCurvedSurface& snapshot, std::uint32_t families,
                               const GpuLineOptions& options) {
    check(snapshot, families, options);
    const GpuSurface& surface = surface_.surface();
    surface.check_vertices(snapshot.vertices);
    const Kernels& kernels = prepare(families);
    std::swap(segments_, old_segments_);
    std::swap(face_counts_, old_face_counts_);
    std::swap(face_groups_, old_face_groups_);
    record_fields(stream, kernels, snapshot, families, options);
    const std::uint32_t faces = surface.face_count();
    const FaceLineParameters parameters{.eye = options.eye,
                                        .faces = faces,
                                        .vertices = surface.vertex_count(),
                                        .crease_angle = options.thresholds[shared::k_creases],
                                        .max_segments = static_cast<std::uint32_t>(room_)};
    stream.dispatch(kernels.count, faces,
                    {snapshot.vertices, surface.faces(), surface_.neighbors(), fields_, directions_,
                     surface_.joined_faces(), face_counts_, face_groups_, face_slots_},
                    parameters);
    stream.dispatch(
        scan_kernel_, 1, {face_groups_, counts_},
        shared::ScanParameters{.groups = static_cast<std::uint32_t>(divide_up(faces, shared::k_count_group)),
                               .most = static_cast<std::uint32_t>(room_)});
    stream.dispatch(kernels.segments, faces,
                    {snapshot.vertices, surface.faces(), surface_.neighbors(), fields_, directions_,
                     surface_.joined_faces(), face_counts_, face_groups_, face_slots_, segments_},
                    parameters);
}

std::size_t GpuLineExtraction::dropped() const {
    shared::LineCounts counts{};
    counts_.download(std::span(&counts, 1));
    return counts.dropped_segments;
}

}  // namespace exemplar
