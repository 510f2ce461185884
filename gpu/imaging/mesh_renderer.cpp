#include "gpu/imaging/mesh_renderer.h"

#include <fmt/format.h>

#include <algorithm>

#include "embedded/imaging_mesh_frag.h"
#include "embedded/imaging_mesh_vert.h"
#include "embedded/imaging_resolve_comp.h"
#include "gpu/imaging/picture.h"
#include "gpu/runtime/vulkan/errors.h"
#include "shaders/shared/render.h"

namespace exemplar {

/// Settings shared by all tiles of a picture.
struct MeshDraw {
    Eigen::Matrix4f view_projection;
    shared::vec4 eye;
    int width, height;  // size of the picture
    RenderOptions options;
    std::array<float, 4> background;  // linear
};

namespace {

// Holds sums of four samples with more precision than the eight bits of a pixel; every device can draw into this
// format.
constexpr VkFormat k_color_format = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr std::size_t k_sample_bytes = 8;
constexpr int k_samples = static_cast<int>(shared::k_render_samples);

VkExtent2D sample_extent(const PictureTile& tile) {
    return {static_cast<std::uint32_t>(tile.width * k_samples), static_cast<std::uint32_t>(tile.height * k_samples)};
}

shared::RenderParameters tile_parameters(const MeshDraw& draw, const PictureTile& tile) {
    shared::RenderParameters parameters{.matrix = {},
                                        .eye = draw.eye,
                                        .ambient = draw.options.ambient,
                                        .ground = draw.options.ground,
                                        .headlight = draw.options.headlight,
                                        .vertex_normals = draw.options.smooth ? 1u : 0u};
    put_matrix(tile_matrix(draw.view_projection, tile, draw.width, draw.height), parameters.matrix);
    return parameters;
}

// Returns the coordinates x, y, z of one vector after the other.
std::span<const float> coordinates(std::span<const Vec3> vectors) {
    static_assert(sizeof(Vec3) == 3 * sizeof(float));
    if (vectors.empty()) return {};
    return {vectors.front().data(), 3 * vectors.size()};
}

// Binds corners, positions, normals and colors; see shaders/imaging/mesh.vert.
DrawPipeline mesh_pipeline(Device& device, VkFormat depth) {
    return {device,
            shaders::imaging_mesh_vert,
            shaders::imaging_mesh_frag,
            {.push_constants = layout_of<shared::RenderParameters>()},
            {.color = k_color_format, .depth = depth}};
}

void check_arguments(const TriangleMesh& mesh, std::span<const Color> face_colors, int width, int height) {
    if (width <= 0 || height <= 0) throw UsageError(fmt::format("render: empty image ({} x {})", width, height));
    if (face_colors.size() != mesh.face_count())
        throw UsageError(fmt::format("render: {} colors for {} faces; give one color per face", face_colors.size(),
                                     mesh.face_count()));
}

}  // namespace

MeshRenderer::MeshRenderer(Device& device, int tile_size, std::size_t part_bytes, Profiler* profiler)
    : device_(device),
      tile_size_(tile_size),
      part_bytes_(buffer_limit(device.info(), part_bytes)),
      canvas_(device, k_color_format),
      pipeline_(mesh_pipeline(device, canvas_.depth_format())),
      resolve_(device, shaders::imaging_resolve_comp, {.push_constants = layout_of<shared::ResolveParameters>()}),
      stream_(device, profiler) {
    if (tile_size <= 0) throw UsageError(fmt::format("render: tiles of {} pixels; give at least 1", tile_size));
}

Image MeshRenderer::render(const TriangleMesh& mesh, std::span<const Color> face_colors, const Camera& camera,
                           int width, int height, const RenderOptions& options) {
    check_arguments(mesh, face_colors, width, height);
    const std::vector<Vec3> normals = options.smooth ? vertex_normals(mesh) : face_normals(mesh);
    const MeshSurface surface{mesh.faces, mesh.vertices, normals, face_colors, options.smooth};
    const bool whole = fits(surface, part_bytes_);
    if (whole) upload(surface);
    reserve_tile(std::min(width, tile_size_), std::min(height, tile_size_));
    MeshDraw draw{.view_projection = camera.view_projection(),
                  .eye = homogeneous_eye(camera),
                  .width = width,
                  .height = height,
                  .options = options,
                  .background = {0, 0, 0, 1}};
    for (std::size_t c = 0; c < 3; ++c)
        draw.background[c] = srgb_to_linear(static_cast<float>(options.background[c]) / 255);
    Image image(width, height, 3);
    for_each_tile(width, height, tile_size_, [&](const PictureTile& tile) {
        if (whole)
            draw_part(tile, draw, {.first = true, .last = true});
        else
            draw_parts(tile, draw, surface);
        resolve_tile(tile, image);
    });
    return image;
}

// Draws a surface that exceeds the limits part by part, through the same buffers; the depth test decides between
// parts.
void MeshRenderer::draw_parts(const PictureTile& tile, const MeshDraw& draw, const MeshSurface& surface) {
    const std::size_t faces = surface.faces.size(), step = faces_per_part(part_bytes_);
    std::size_t first = 0;
    do {
        const std::size_t count = std::min(step, faces - first);
        upload(cut_part(surface, first, count).surface(surface.vertex_normals));
        draw_part(tile, draw, {.first = first == 0, .last = first + count == faces});
        first += count;
    } while (first < faces);
}

void MeshRenderer::upload(const MeshSurface& surface) {
    corners_ = Buffer::of<Face>(device_, surface.faces);
    positions_ = Buffer::of(device_, coordinates(surface.vertices));
    normals_ = Buffer::of(device_, coordinates(surface.normals));
    colors_ = Buffer::of<std::uint32_t>(device_, packed_colors(surface.colors));
    corner_count_ = static_cast<std::uint32_t>(3 * surface.faces.size());
}

void MeshRenderer::reserve_tile(int width, int height) {
    if (width <= tile_width_ && height <= tile_height_) return;
    width = std::max(width, tile_width_);
    height = std::max(height, tile_height_);
    tile_width_ = tile_height_ = 0;  // until everything has been allocated
    const VkExtent2D extent = sample_extent(PictureTile{0, 0, width, height});
    canvas_.resize(extent);
    samples_ = Buffer(device_, k_sample_bytes * extent.width * extent.height);
    pixels_ =
        Buffer(device_, sizeof(std::uint32_t) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    tile_width_ = width;
    tile_height_ = height;
}

void MeshRenderer::draw_part(const PictureTile& tile, const MeshDraw& draw, PartPosition turn) {
    if (turn.first) canvas_.begin(stream_);
    PassTarget target = turn.first ? canvas_.cleared(draw.background) : canvas_.target();
    target.extent = sample_extent(tile);
    Pass pass("mesh", target);
    pass.draw(pipeline_, {.vertices = corner_count_}, {corners_, positions_, normals_, colors_},
              tile_parameters(draw, tile));
    stream_.render(pass);
    if (turn.last) {
        canvas_.end(stream_);
        canvas_.copy_color(stream_, sample_extent(tile), samples_);
    }
    stream_.finish();
}

void MeshRenderer::resolve_tile(const PictureTile& tile, Image& image) {
    const shared::ResolveParameters size{static_cast<std::uint32_t>(tile.width),
                                         static_cast<std::uint32_t>(tile.height)};
    tile_pixels_.resize(std::size_t{size.width} * size.height);
    stream_.dispatch(resolve_, Threads(size.width, size.height), {samples_, pixels_}, size);
    stream_.fetch(pixels_, std::span(tile_pixels_));
    for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x) {
            const std::uint32_t packed =
                tile_pixels_[static_cast<std::size_t>(y) * size.width + static_cast<std::size_t>(x)];
            const auto pixel = image.pixel(tile.x + x, tile.y + y);
            for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(packed >> (8 * c));
        }
}

}  // namespace exemplar
