#include "gpu/lines/line_renderer.h"

#include <fmt/format.h>

#include <cstddef>

#include "embedded/lines_stroke_frag.h"
#include "embedded/lines_stroke_vert.h"
#include "gpu/curvature/surface/texels.h"
#include "gpu/imaging/picture.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

using shared::LineCounts;
using shared::uvec4;
using shared::vec4;

DrawPipeline stroke_pipeline(Device& device, VkFormat color) {
    return {device,
            shaders::lines_stroke_vert,
            shaders::lines_stroke_frag,
            {.push_constants = layout_of<shared::StrokeDrawParameters>(),
             .elements = {layout_of<uvec4>(), layout_of<vec4>(), layout_of<std::uint32_t>(),
                          layout_of<shared::StrokeLook>(), layout_of<float>(), layout_of<shared::vec2>(),
                          layout_of<vec4>()}},
            {.color = color, .blends = true}};
}

// Maximum vertex index that every device supports in index buffers.
constexpr std::uint32_t k_max_indexed = (1u << 24) - 1;

}  // namespace

LineRenderer::Lines::Lines(Device& device, const GpuLineSurface& surface)
    : extraction(surface), chains(extraction), strokes(chains), coherence(strokes) {
    pipelines[Canvas::k_rgba] = stroke_pipeline(device, Canvas::k_rgba);
}

LineRenderer::LineRenderer(Device& device, const GpuLineSurface& surface)
    : device_(device),
      surface_(surface),
      canvas_(device),
      painter_(device, Canvas::k_rgba, canvas_.depth_format()),
      textures_(device, sizeof(float)) {
    if (canvas_.depth_format() != VK_FORMAT_D32_SFLOAT)
        throw DeviceError(fmt::format("device '{}' has no depth of 32 bits; choose another", device.info().name));
}

void LineRenderer::set_face_colors(std::span<const Color> colors) {
    if (colors.size() != surface_.surface().face_count())
        throw UsageError(fmt::format("{} colors for {} faces; give one color per face", colors.size(),
                                     surface_.surface().face_count()));
    face_colors_ = Buffer::of<std::uint32_t>(device_, packed_colors(colors));
}

void LineRenderer::set_part_inks(const PartInks& inks) {
    inks_.reset();
    if (!inks.empty()) inks_.emplace(surface_.surface(), inks);
}

void LineRenderer::set_textures(std::span<const std::uint8_t> opacities) {
    if (opacities.size() % (shared::k_texture_width * shared::k_texture_height) != 0)
        throw UsageError(fmt::format("{} opacities are no textures of {} x {}", opacities.size(),
                                     shared::k_texture_width, shared::k_texture_height));
    std::vector<float> values;
    values.reserve(opacities.size());
    for (const std::uint8_t opacity : opacities) values.push_back(static_cast<float>(opacity) / 255);
    check_texels(device_, values.size(), "the textures of strokes");
    textures_ = Buffer::of<float>(device_, values);
}

void LineRenderer::resize(int width, int height) {
    if (width <= 0 || height <= 0) throw UsageError(fmt::format("an empty picture ({} x {})", width, height));
    const VkExtent2D extent{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
    const std::size_t pixels = std::size_t{extent.width} * extent.height;
    check_texels(device_, pixels, "the pixels of a picture");
    canvas_.resize(extent);
    reserve(device_, depths_, pixels * sizeof(float));
}

void LineRenderer::draw_surface(Stream& stream, const GpuCurvedSurface& snapshot, const LinePicture& picture) {
    canvas_.begin(stream);
    Pass pass("surface", canvas_.cleared(background_of(picture.surface)));
    const GpuSurface& surface = surface_.surface();
    painter_.draw(pass,
                  {.face_count = surface.face_count(),
                   .faces = &surface.faces(),
                   .indices = surface.vertex_count() <= k_max_indexed ? &surface.indices() : nullptr,
                   .vertices = &snapshot.vertices,
                   .normals = &snapshot.normals,
                   .colors = face_colors_ ? &face_colors_ : nullptr,
                   .first = snapshot.first,
                   .second = snapshot.second},
                  picture.view.camera, picture.surface);
    stream.render(pass);
}

void LineRenderer::draw_strokes(Stream& stream, const LinePicture& picture, const StrokeTarget& target) {
    DrawPipeline& pipeline = lines_->pipelines[target.format];
    if (!pipeline) pipeline = stroke_pipeline(device_, target.format);
    Pass pass("lines/strokes", {.color = target.color, .extent = canvas_.extent()});
    pass.draw(pipeline, {.indirect = &lines_->extraction.counts(), .indirect_offset = offsetof(LineCounts, draw)},
              {lines_->chains.points(), lines_->strokes.strokes(), lines_->strokes.visible(), lines_->strokes.looks(),
               textures_, lines_->coherence.phases(), inks_ ? inks_->inks() : lines_->strokes.looks()},
              shared::StrokeDrawParameters{.width = static_cast<float>(picture.view.width),
                                           .height = static_cast<float>(picture.view.height)});
    stream.render(pass);
}

// Records all up to the strokes, and draws the surface into the canvas for that.
void LineRenderer::record_strokes(Stream& stream, const GpuCurvedSurface& snapshot, const LinePicture& picture) {
    const StrokeView& view = picture.view;
    if (!lines_) lines_.emplace(device_, surface_);
    lines_->extraction.record(
        stream, snapshot, picture.families,
        {.eye = homogeneous_eye(view.camera), .feature_size = view.feature_size, .thresholds = picture.thresholds});
    lines_->chains.record(stream, snapshot.vertices, view.camera, view.width, view.height);
    draw_surface(stream, snapshot, picture);
    canvas_.copy_depth(stream, depths_);
    lines_->strokes.record(stream, snapshot, depths_, view, picture.looks, inks_ ? &*inks_ : nullptr);
    lines_->coherence.record(stream, snapshot.vertices, view, picture.coherent);
}

void LineRenderer::record(Stream& stream, const GpuCurvedSurface& snapshot, const LinePicture& picture) {
    resize(picture.view.width, picture.view.height);
    transparent_ = picture.surface.transparent;
    if (picture.families == 0) {
        surface_.surface().check_vertices(snapshot.vertices);
        draw_surface(stream, snapshot, picture);
    } else {
        record_strokes(stream, snapshot, picture);
        canvas_.separate_passes(stream);
        draw_strokes(stream, picture, {.color = canvas_.color_view(), .format = Canvas::k_rgba});
    }
    canvas_.end(stream);
}

void LineRenderer::record_over(Stream& stream, const GpuCurvedSurface& snapshot, const LinePicture& picture,
                               const StrokeTarget& target) {
    if (picture.families == 0) return;
    resize(picture.view.width, picture.view.height);
    LinePicture bare = picture;
    bare.surface = LinePicture{}.surface;
    record_strokes(stream, snapshot, bare);
    draw_strokes(stream, bare, target);
}

Image LineRenderer::render(Stream& stream, const GpuCurvedSurface& snapshot, const LinePicture& picture) {
    record(stream, snapshot, picture);
    record_download(stream);
    stream.finish();
    return read_image();
}

}  // namespace exemplar
