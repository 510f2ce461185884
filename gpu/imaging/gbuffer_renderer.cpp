#include "gpu/imaging/gbuffer_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "embedded/imaging_gbuffer_frag.h"
#include "embedded/imaging_gbuffer_points_comp.h"
#include "embedded/imaging_gbuffer_vert.h"
#include "gpu/imaging/picture.h"
#include "gpu/runtime/vulkan/errors.h"
#include "shaders/shared/gbuffer.h"

namespace exemplar {
namespace {

using shared::FaceParameters;
using shared::PointParameters;
using shared::uvec4;
using shared::vec4;

static_assert(shared::k_gbuffer_no_face == k_no_face);

// One number per pixel; every device can draw into it.
constexpr VkFormat k_number_format = VK_FORMAT_R32_UINT;
constexpr std::size_t k_point_bytes = 2 * sizeof(float);  // maximum size of an output per pixel

DrawPipeline face_pipeline(Device& device, VkFormat depth) {
    return {device,
            shaders::imaging_gbuffer_vert,
            shaders::imaging_gbuffer_frag,
            {.push_constants = layout_of<FaceParameters>(), .elements = {layout_of<vec4>(), layout_of<uvec4>()}},
            {.color = k_number_format, .depth = depth}};
}

Kernel point_kernel(Device& device) {
    return {device,
            shaders::imaging_gbuffer_points_comp,
            {.push_constants = layout_of<PointParameters>(),
             .elements = {layout_of<vec4>(), layout_of<uvec4>(), layout_of<std::uint32_t>(), layout_of<std::uint32_t>(),
                          layout_of<float>(), layout_of<float>()}}};
}

void check_size(const Device& device, int width, int height) {
    check_gbuffer_size(width, height);
    const std::uint64_t bytes = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * k_point_bytes;
    if (const std::uint64_t limit = buffer_limit(device.info(), bytes); bytes > limit)
        throw DeviceLimitError(
            fmt::format("a G-buffer of {} x {} pixels is over the limit of {} pixels of device '{}'; "
                        "render a smaller one",
                        width, height, limit / k_point_bytes, device.info().name),
            bytes, limit);
}

// Returns the limit for parts of meshes, which is measured in vectors of three floats; on the device these have
// four.
std::size_t part_limit(const DeviceInfo& info, std::size_t part_bytes) {
    return std::min<std::size_t>(buffer_limit(info, part_bytes), info.max_texels * sizeof(vec4)) / sizeof(vec4) *
           sizeof(Vec3);
}

vec4 matrix_row(const Eigen::Matrix4f& matrix, int row) {
    return {matrix(row, 0), matrix(row, 1), matrix(row, 2), matrix(row, 3)};
}

vec4 negated(const vec4& v) {
    return {-v.x, -v.y, -v.z, -v.w};
}

}  // namespace

GBuffer GpuGBuffer::fetch(Stream& stream) const {
    GBuffer out{.width = width, .height = height, .face = {}, .barycentric = {}, .depth = {}};
    out.face.resize(out.size());
    out.barycentric.resize(out.size());
    out.depth.resize(out.size());
    std::vector<float> corners(2 * out.size());
    const auto part = [](const Buffer& buffer, auto& values) {
        return BufferReadback{&buffer, 0, std::as_writable_bytes(std::span(values))};
    };
    stream.fetch(std::array{part(face, out.face), part(depth, out.depth), part(barycentric, corners)});
    for (std::size_t p = 0; p < out.size(); ++p) out.barycentric[p] = {corners[p], corners[out.size() + p]};
    return out;
}

GpuGBufferRenderer::GpuGBufferRenderer(Device& device, int tile_size, std::size_t part_bytes, Profiler* profiler)
    : device_(device),
      tile_size_(tile_size),
      part_bytes_(part_limit(device.info(), part_bytes)),
      canvas_(device, k_number_format),
      pipeline_(face_pipeline(device, canvas_.depth_format())),
      points_(point_kernel(device)),
      stream_(device, profiler) {
    if (tile_size <= 0) throw UsageError(fmt::format("G-buffer: tiles of {} pixels; give at least 1", tile_size));
}

GBuffer GpuGBufferRenderer::render(const TriangleMesh& mesh, const Camera& camera, int width, int height) {
    return record(mesh, camera, width, height).fetch(stream_);
}

GpuGBuffer GpuGBufferRenderer::render_on_device(const TriangleMesh& mesh, const Camera& camera, int width, int height) {
    GpuGBuffer out = record(mesh, camera, width, height);
    stream_.finish();
    return out;
}

// Records the rendering; what must be done before a next tile or part has been waited for.
GpuGBuffer GpuGBufferRenderer::record(const TriangleMesh& mesh, const Camera& camera, int width, int height) {
    check_size(device_, width, height);
    const MeshSurface surface{.faces = mesh.faces, .vertices = mesh.vertices, .normals = {}, .colors = {}};
    whole_ = fits(surface, part_bytes_) ? upload(surface, 0) : Part{};
    reserve_tile(std::min(width, tile_size_), std::min(height, tile_size_));
    const std::size_t words = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * sizeof(float);
    GpuGBuffer out{.width = width,
                   .height = height,
                   .face = Buffer(device_, words),
                   .barycentric = Buffer(device_, 2 * words),
                   .depth = Buffer(device_, words)};
    const View view{camera, width, height};
    for_each_tile(width, height, tile_size_, [&](const PictureTile& tile) {
        stream_.finish();
        draw_faces(tile, view, surface);
        find_points(tile, view, surface, out);
    });
    return out;
}

GpuGBufferRenderer::Part GpuGBufferRenderer::upload(const MeshSurface& surface, std::size_t first) {
    std::vector<vec4> positions;
    positions.reserve(surface.vertices.size());
    for (const Vec3& v : surface.vertices) positions.push_back({v.x(), v.y(), v.z(), 1});
    std::vector<uvec4> faces;
    faces.reserve(surface.faces.size());
    for (const Face& face : surface.faces) faces.push_back({face[0], face[1], face[2], 0});
    return {.first = static_cast<std::uint32_t>(first),
            .end = static_cast<std::uint32_t>(first + faces.size()),
            .positions = uploaded<vec4>(device_, stream_, positions),
            .faces = uploaded<uvec4>(device_, stream_, faces)};
}

// Calls use(part) for all parts. Work on one of several parts is done before the next, so that few are in memory.
template <typename Use>
void GpuGBufferRenderer::for_each_part(const MeshSurface& surface, Use&& use) {
    if (whole_.faces) {
        use(whole_);
        return;
    }
    const std::size_t faces = surface.faces.size(), step = faces_per_part(part_bytes_);
    for (std::size_t first = 0; first < faces; first += step) {
        const MeshPart part = cut_part(surface, first, std::min(step, faces - first));
        use(upload(part.surface(false), first));
        stream_.finish();
    }
}

void GpuGBufferRenderer::reserve_tile(int width, int height) {
    const VkExtent2D extent{std::max(static_cast<std::uint32_t>(width), canvas_.extent().width),
                            std::max(static_cast<std::uint32_t>(height), canvas_.extent().height)};
    canvas_.resize(extent);
    reserve(device_, numbers_, sizeof(std::uint32_t) * extent.width * extent.height);
}

void GpuGBufferRenderer::draw_faces(const PictureTile& tile, const View& view, const MeshSurface& surface) {
    const VkExtent2D extent{static_cast<std::uint32_t>(tile.width), static_cast<std::uint32_t>(tile.height)};
    FaceParameters parameters{.matrix = {}, .first_face = 0, .unused0 = 0, .unused1 = 0, .unused2 = 0};
    put_matrix(tile_matrix(view.camera.view_projection(), tile, view.width, view.height), parameters.matrix);
    canvas_.begin(stream_);
    PassTarget target = canvas_.cleared({});
    for_each_part(surface, [&](const Part& part) {
        parameters.first_face = part.first;
        target.extent = extent;
        Pass pass("faces", target);
        pass.draw(pipeline_, {.vertices = 3 * (part.end - part.first)}, {part.positions, part.faces}, parameters);
        stream_.render(pass);
        target = canvas_.target();
    });
    canvas_.end(stream_);
    canvas_.copy_color(stream_, extent, numbers_);
}

void GpuGBufferRenderer::find_points(const PictureTile& tile, const View& view, const MeshSurface& surface,
                                     const GpuGBuffer& out) {
    const Eigen::Matrix4f clip = view.camera.view_projection();
    PointParameters parameters{.clip_x = matrix_row(clip, 0),
                               .clip_y = matrix_row(clip, 1),
                               .clip_w = matrix_row(clip, 3),
                               .axis = negated(matrix_row(view.camera.view, 2)),
                               .tile_x = static_cast<std::uint32_t>(tile.x),
                               .tile_y = static_cast<std::uint32_t>(tile.y),
                               .tile_width = static_cast<std::uint32_t>(tile.width),
                               .tile_height = static_cast<std::uint32_t>(tile.height),
                               .width = static_cast<std::uint32_t>(view.width),
                               .height = static_cast<std::uint32_t>(view.height),
                               .first_face = 0,
                               .end_face = 0};
    for_each_part(surface, [&](const Part& part) {
        parameters.first_face = part.first;
        parameters.end_face = part.end;
        stream_.dispatch(points_, Threads(parameters.tile_width, parameters.tile_height),
                         {part.positions, part.faces, numbers_, out.face, out.barycentric, out.depth}, parameters);
    });
}

}  // namespace exemplar
