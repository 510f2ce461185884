#include "gpu/lines/line_renderer.h"

#include <fmt/format.h>

#include <cstddef>

#include "embedded/lines_stroke_frag.h"
#include "embedded/lines_stroke_vert.h"
#include "embedded/lines_surface_frag.h"
#include "embedded/lines_surface_vert.h"
#include "gpu/curvature/texels.h"
#include "gpu/imaging/picture.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

using shared::LineCounts;
using shared::SurfaceDrawParameters;
using shared::uvec4;
using shared::vec4;

constexpr VkPipelineStageFlags2 k_depth_tests =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkAccessFlags2 k_depth_use =
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags2 k_color_use = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
constexpr Transition k_color_begins{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_NONE,
                                    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, k_color_use};
constexpr Transition k_color_goes_on{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                     VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, k_color_use};
constexpr Transition k_color_ends{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                  VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                  VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr Transition k_depth_begins{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | k_depth_tests,
                                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, k_depth_tests, k_depth_use};
constexpr Transition k_depth_ends{k_depth_tests, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};

DrawPipeline surface_pipeline(Device& device, VkFormat depth) {
    return {device,
            shaders::lines_surface_vert,
            shaders::lines_surface_frag,
            {.push_constants = layout_of<SurfaceDrawParameters>(),
             .elements = {layout_of<uvec4>(), layout_of<vec4>(), layout_of<vec4>(), layout_of<std::uint32_t>(),
                          layout_of<vec4>(), layout_of<vec4>()}},
            {.color = LineRenderer::k_format, .depth = depth}};
}

DrawPipeline stroke_pipeline(Device& device) {
    return {device,
            shaders::lines_stroke_vert,
            shaders::lines_stroke_frag,
            {.push_constants = layout_of<shared::StrokeDrawParameters>(),
             .elements = {layout_of<vec4>(), layout_of<vec4>(), layout_of<std::uint32_t>(),
                          layout_of<shared::StrokeLook>(), layout_of<float>(), layout_of<shared::vec2>()}},
            {.color = LineRenderer::k_format, .blends = true}};
}

vec4 color_and(const Color& color, float last) {
    return {static_cast<float>(color[0]) / 255, static_cast<float>(color[1]) / 255, static_cast<float>(color[2]) / 255,
            last};
}

SurfaceDrawParameters surface_parameters(const LinePicture& picture, bool curved) {
    SurfaceLook look = picture.surface;
    if (look.coloring == SurfaceLook::Coloring::curvature && !curved) look.coloring = SurfaceLook::Coloring::paper;
    SurfaceDrawParameters parameters{.matrix = {},
                                     .eye = homogeneous_eye(picture.view.camera),
                                     .paper = color_and(look.paper, static_cast<float>(look.shading)),
                                     .coloring = static_cast<std::uint32_t>(look.coloring),
                                     .scale = picture.view.feature_size * 4,
                                     .alpha = look.transparent && look.transparent_paper ? 0.0f : 1.0f,
                                     .unused = 0};
    put_matrix(picture.view.camera.view_projection(), parameters.matrix);
    return parameters;
}

}  // namespace

LineRenderer::LineRenderer(Device& device, const GpuLineSurface& surface)
    : device_(device),
      surface_(surface),
      lines_(surface),
      chains_(lines_),
      strokes_(chains_),
      coherence_(strokes_),
      depth_format_(VK_FORMAT_D32_SFLOAT),
      surface_pipeline_(surface_pipeline(device, depth_format_)),
      stroke_pipeline_(stroke_pipeline(device)),
      face_colors_(device, surface.surface().face_count() * sizeof(std::uint32_t)),
      textures_(device, sizeof(float)) {
    if (depth_format(device) != depth_format_)
        throw DeviceError(fmt::format("device '{}' has no depth of 32 bits; choose another", device.info().name));
}

void LineRenderer::set_face_colors(std::span<const Color> colors) {
    if (colors.size() != surface_.surface().face_count())
        throw UsageError(fmt::format("{} colors for {} faces; give one color per face", colors.size(),
                                     surface_.surface().face_count()));
    std::vector<std::uint32_t> packed;
    packed.reserve(colors.size());
    for (const Color& color : colors)
        packed.push_back(color[0] | std::uint32_t{color[1]} << 8 | std::uint32_t{color[2]} << 16);
    face_colors_.upload<std::uint32_t>(packed);
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
    if (extent.width == extent_.width && extent.height == extent_.height) return;
    const std::size_t pixels = std::size_t{extent.width} * extent.height;
    check_texels(device_, pixels, "the pixels of a picture");
    extent_ = {};
    color_ =
        Attachment(device_, k_format, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                   VK_IMAGE_ASPECT_COLOR_BIT);
    depth_ = Attachment(device_, depth_format_, extent,
                        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                        VK_IMAGE_ASPECT_DEPTH_BIT);
    depths_ = Buffer(device_, pixels * sizeof(float));
    pixels_ = Buffer();
    extent_ = extent;
}

void LineRenderer::draw_surface(Stream& stream, const GpuCurvedSurface& moment, const LinePicture& picture) {
    stream.transition(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, k_color_begins);
    stream.transition(depth_.image(), VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, k_depth_begins);
    const bool opaque = !picture.surface.transparent;
    const vec4 background = opaque ? color_and(picture.surface.background, 1) : vec4{0, 0, 0, 0};
    Pass pass("lines/surface", {.color = color_.view(),
                                .depth = depth_.view(),
                                .extent = extent_,
                                .clear_color = {{background.x, background.y, background.z, background.w}},
                                .clear_depth = 1.0f});
    const bool curved = moment.first && moment.second;
    pass.draw(surface_pipeline_, {.vertices = 3 * surface_.surface().face_count()},
              {surface_.surface().faces(), moment.vertices, moment.normals, face_colors_,
               curved ? *moment.first : moment.vertices, curved ? *moment.second : moment.vertices},
              surface_parameters(picture, curved));
    stream.render(pass);
    stream.transition(depth_.image(), VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, k_depth_ends);
    stream.copy_image(depth_.image(), VK_IMAGE_ASPECT_DEPTH_BIT, extent_, sizeof(float), depths_);
}

void LineRenderer::draw_strokes(Stream& stream, const LinePicture& picture) {
    stream.transition(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, k_color_goes_on);
    Pass pass("lines/strokes", {.color = color_.view(), .extent = extent_});
    pass.draw(
        stroke_pipeline_, {.indirect = &lines_.counts(), .indirect_offset = offsetof(LineCounts, draw)},
        {chains_.points(), strokes_.strokes(), strokes_.visible(), strokes_.looks(), textures_, coherence_.phases()},
        shared::StrokeDrawParameters{.width = static_cast<float>(picture.view.width),
                                     .height = static_cast<float>(picture.view.height)});
    stream.render(pass);
    stream.transition(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, k_color_ends);
}

void LineRenderer::record(Stream& stream, const GpuCurvedSurface& moment, const LinePicture& picture) {
    const StrokeView& view = picture.view;
    resize(view.width, view.height);
    transparent_ = picture.surface.transparent;
    lines_.record(
        stream, moment, picture.families,
        {.eye = homogeneous_eye(view.camera), .feature_size = view.feature_size, .thresholds = picture.thresholds});
    chains_.record(stream, moment.vertices, view.camera, view.width, view.height);
    draw_surface(stream, moment, picture);
    strokes_.record(stream, moment, depths_, view, picture.looks);
    coherence_.record(stream, moment.vertices, view, picture.coherent);
    draw_strokes(stream, picture);
}

void LineRenderer::record_download(Stream& stream) {
    reserve(device_, pixels_, std::size_t{4} * extent_.width * extent_.height);
    stream.copy_image(color_.image(), VK_IMAGE_ASPECT_COLOR_BIT, extent_, 4, pixels_);
}

Image LineRenderer::read_image() const {
    std::vector<std::uint8_t> rgba(std::size_t{4} * extent_.width * extent_.height);
    pixels_.download<std::uint8_t>(rgba);
    const std::size_t channels = transparent_ ? 4 : 3;
    Image image(static_cast<int>(extent_.width), static_cast<int>(extent_.height), static_cast<int>(channels));
    for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
        const std::uint8_t alpha = rgba[4 * i + 3];
        for (std::size_t c = 0; c < 3; ++c) {
            const unsigned value = rgba[4 * i + c];
            // Colors were multiplied by alpha.
            const unsigned straight = alpha ? std::min(255u, (255 * value + alpha / 2) / alpha) : 0;
            image.data[channels * i + c] = static_cast<std::uint8_t>(transparent_ ? straight : value);
        }
        if (transparent_) image.data[channels * i + 3] = alpha;
    }
    return image;
}

Image LineRenderer::render(Stream& stream, const GpuCurvedSurface& moment, const LinePicture& picture) {
    record(stream, moment, picture);
    record_download(stream);
    stream.finish();
    return read_image();
}

}  // namespace exemplar
