#include "gpu/hatching/pixel_projection.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "embedded/hatching_directions_comp.h"
#include "embedded/hatching_project_comp.h"
#include "embedded/hatching_view_curvature_comp.h"
#include "gpu/imaging/picture.h"
#include "host/core/parallel.h"
#include "shaders/shared/hatching_features.h"

namespace exemplar {
namespace {

using shared::DirectionParameters;
using shared::k_slab_fields;
using shared::k_slab_lanes;
using shared::k_slab_quads;
using shared::ProjectionParameters;
using shared::uvec4;
using shared::vec4;
using shared::ViewCurvatureParameters;
using Word = std::uint32_t;

static_assert(k_slab_lanes == 4 * k_slab_quads);
static_assert(shared::k_curvature_texels == 2 + 3 * k_hatching_scales.size());
constexpr std::size_t k_scale_columns = 2 * k_curvature_functions;
static_assert(shared::k_curvature_values == k_curvature_functions && k_scale_columns < shared::k_other_scale);

constexpr std::size_t k_block = 1024;  // vertices that are packed at once

/// Returns the number of points of a tile, a multiple of 4 (a texel of a column), so that its columns fit the limits
/// of a kernel.
std::size_t tile_limit(const DeviceInfo& info, std::size_t points) {
    const std::size_t texels = info.max_texels, bytes = buffer_limit(info, points * k_slab_lanes * sizeof(float));
    return std::max<std::size_t>(std::min({points, texels / 2, bytes / (k_slab_lanes * sizeof(float))}) / 4 * 4, 4);
}

template <typename T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

/// Calls use(columns) for every group of at most k_slab_lanes columns.
template <typename Use>
void for_each_slab(std::span<const std::uint32_t> which, Use&& use) {
    for (std::size_t first = 0; first < which.size(); first += k_slab_lanes)
        use(which.subspan(first, std::min<std::size_t>(k_slab_lanes, which.size() - first)));
}

vec4 texel_of(const Vec3& v, float w) {
    return {v.x(), v.y(), v.z(), w};
}

vec4 matrix_row(const Eigen::Matrix4f& matrix, int row) {
    return {matrix(row, 0), matrix(row, 1), matrix(row, 2), matrix(row, 3)};
}

/// Returns a buffer of `rows` x `columns` texels, filled in parallel: write(i, texels) writes those of row i.
template <typename Write>
Buffer packed(Device& device, Stream& stream, std::size_t rows, std::size_t columns, Write&& write) {
    Buffer buffer(device, rows * columns * sizeof(vec4));
    stream.upload_with(buffer, rows * columns * sizeof(vec4), 0, [&](std::span<std::byte> memory) {
        auto* const texels = reinterpret_cast<vec4*>(memory.data());
        parallel_for(
            rows, [&](std::size_t i) { write(i, texels + i * columns); }, k_block);
    });
    return buffer;
}

Kernel project_kernel(Device& device) {
    return {device,
            shaders::hatching_project_comp,
            {.push_constants = layout_of<ProjectionParameters>(),
             .elements = {layout_of<uvec4>(), layout_of<uvec4>(), layout_of<vec4>(), layout_of<vec4>(),
                          layout_of<vec4>()}}};
}

Kernel directions_kernel(Device& device) {
    return {device,
            shaders::hatching_directions_comp,
            {.push_constants = layout_of<DirectionParameters>(),
             .elements = {layout_of<uvec4>(), layout_of<Word>(), layout_of<float>(), layout_of<vec4>(),
                          layout_of<vec4>(), layout_of<shared::vec2>()}}};
}

Kernel view_curvature_kernel(Device& device) {
    return {
        device,
        shaders::hatching_view_curvature_comp,
        {.push_constants = layout_of<ViewCurvatureParameters>(), .elements = {layout_of<vec4>(), layout_of<float>()}}};
}

}  // namespace

GpuPixelProjection::GpuPixelProjection(Device& device, Profiler* profiler, std::size_t tile_points,
                                       std::size_t kept_bytes)
    : device_(device),
      tile_points_(tile_limit(device.info(), tile_points)),
      stream_(device, profiler),
      project_(project_kernel(device)),
      directions_(directions_kernel(device)),
      view_curvature_(view_curvature_kernel(device)),
      kept_(kept_bytes) {}

void GpuPixelProjection::scalars(const TriangleMesh& mesh, const FacePoints& points, const FeatureMatrix& values,
                                 std::span<const std::uint32_t> which, std::span<float> out) {
    check_scalars(mesh, points, values, which, out);
    if (out.empty()) return;
    std::vector<Shared> slabs;
    for_each_slab(which, [&](auto columns) { slabs.push_back(scalar_slab(values, columns)); });
    project(mesh, points, slabs, out);
}

void GpuPixelProjection::curvature(const HatchingSurface& surface, const HatchingView& view, const FacePoints& points,
                                   std::span<const std::uint32_t> which, std::span<float> out) {
    check_curvature(surface, points, which, out);
    if (out.empty()) return;
    const Shared states = curvature_states(surface);
    std::vector<Shared> slabs;
    for_each_slab(which, [&](auto columns) { slabs.push_back(curvature_slab(*states, surface, view, columns)); });
    project(surface.mesh, points, slabs, out);
}

void GpuPixelProjection::project(const TriangleMesh& mesh, const FacePoints& points, std::span<const Shared> slabs,
                                 std::span<float> out) {
    const Shared on_faces = corners(mesh);
    const std::size_t columns = out.size() / points.size();
    for_each_tile(points, [&](const Tile& tile) {
        const std::size_t column_bytes = tile.stride * sizeof(float);
        reserve(device_, columns_, std::min<std::size_t>(k_slab_lanes, (columns + 3) / 4 * 4) * column_bytes);
        for (std::size_t s = 0; s < slabs.size(); ++s) {
            std::vector<HostReadback> parts;
            for (std::size_t k = s * k_slab_lanes; k < std::min(columns, (s + 1) * k_slab_lanes); ++k)
                parts.push_back({parts.size() * column_bytes,
                                 std::as_writable_bytes(out.subspan(k * points.size() + tile.first, tile.count))});
            const ProjectionParameters parameters{.points = static_cast<Word>(tile.count),
                                                  .stride = static_cast<Word>(tile.stride),
                                                  .quads = static_cast<Word>((parts.size() + 3) / 4)};
            stream_.dispatch(project_, tile.stride / 4, {*on_faces, faces_, barycentrics_, *slabs[s], columns_},
                             parameters);
            download(columns_, parts);
        }
    });
    finish();
}

void GpuPixelProjection::directions(const TriangleMesh& mesh, const HatchingView& view, const FacePoints& points,
                                    std::span<const std::span<const Vec3>> fields, std::span<DoubledAngle> out) {
    check_directions(mesh, points, fields, out);
    if (out.empty()) return;
    const Shared on_faces = corners(mesh), on_vertices = positions(mesh);
    const Eigen::Matrix4f clip = view.camera.view_projection();
    DirectionParameters parameters{.clip_x = matrix_row(clip, 0),
                                   .clip_y = matrix_row(clip, 1),
                                   .clip_w = matrix_row(clip, 3),
                                   .points = 0,
                                   .stride = 0,
                                   .fields = 0,
                                   .width = static_cast<float>(view.width),
                                   .height = static_cast<float>(view.height),
                                   .unused0 = 0,
                                   .unused1 = 0,
                                   .unused2 = 0};
    for_each_tile(points, [&](const Tile& tile) {
        parameters.points = static_cast<Word>(tile.count);
        parameters.stride = static_cast<Word>(tile.stride);
        const std::size_t field_bytes = tile.stride * sizeof(DoubledAngle);
        reserve(device_, doubled_, k_slab_fields * field_bytes);
        for (std::size_t first = 0; first < fields.size(); first += k_slab_fields) {
            const auto some = fields.subspan(first, std::min<std::size_t>(k_slab_fields, fields.size() - first));
            parameters.fields = static_cast<Word>(some.size());
            const Shared slab = directions_slab(some);
            stream_.dispatch(directions_, tile.count, {*on_faces, faces_, barycentrics_, *on_vertices, *slab, doubled_},
                             parameters);
            std::vector<HostReadback> parts;
            for (std::size_t k = 0; k < some.size(); ++k)
                parts.push_back({k * field_bytes, std::as_writable_bytes(out.subspan(
                                                      (first + k) * points.size() + tile.first, tile.count))});
            download(doubled_, parts);
        }
    });
    finish();
}

void GpuPixelProjection::finish() {
    stream_.finish();
    waiting_bytes_ = 0;
}

// Records the download of parts of a buffer. Waits for all that is recorded once it is much, as it passes through
// staging memory of that size.
void GpuPixelProjection::download(const Buffer& source, std::span<const HostReadback> parts) {
    constexpr std::size_t k_much = std::size_t{128} << 20;
    for (const HostReadback& part : parts) {
        stream_.download<std::byte>(source, part.target, part.offset);
        waiting_bytes_ += part.target.size();
    }
    if (waiting_bytes_ >= k_much) finish();
}

/// Uploads the points tile by tile, and calls use(tile) for each.
template <typename Use>
void GpuPixelProjection::for_each_tile(const FacePoints& points, Use&& use) {
    for (std::size_t first = 0; first < points.size(); first += tile_points_) {
        const std::size_t count = std::min(tile_points_, points.size() - first);
        const Tile tile{first, count, (count + 3) / 4 * 4};
        upload_points(points, tile);
        use(tile);
    }
}

/// Points that pad a tile to a multiple of four lie on face 0.
void GpuPixelProjection::upload_points(const FacePoints& points, const Tile& tile) {
    reserve(device_, faces_, tile.stride * sizeof(Word));
    reserve(device_, barycentrics_, 2 * tile.stride * sizeof(float));
    stream_.upload_with(faces_, tile.stride * sizeof(Word), 0, [&](std::span<std::byte> memory) {
        std::ranges::fill(memory.last((tile.stride - tile.count) * sizeof(Word)), std::byte{0});
        std::memcpy(memory.data(), points.face.data() + tile.first, tile.count * sizeof(Word));
    });
    stream_.upload_with(barycentrics_, 2 * tile.stride * sizeof(float), 0, [&](std::span<std::byte> memory) {
        auto* const values = reinterpret_cast<float*>(memory.data());
        for (std::size_t corner = 0; corner < 2; ++corner) {
            for (std::size_t i = 0; i < tile.stride; ++i)
                values[corner * tile.stride + i] = i < tile.count ? points.barycentric[tile.first + i][corner] : 0.0f;
        }
    });
}

GpuPixelProjection::Shared GpuPixelProjection::corners(const TriangleMesh& mesh) {
    return kept_.get(content_key("corners", {bytes_of(mesh.faces)}), [&] {
        return packed(device_, stream_, mesh.face_count(), 1, [&](std::size_t f, vec4* out) {
            const uvec4 face{mesh.faces[f][0], mesh.faces[f][1], mesh.faces[f][2], 0};
            std::memcpy(out, &face, sizeof face);
        });
    });
}

GpuPixelProjection::Shared GpuPixelProjection::positions(const TriangleMesh& mesh) {
    return kept_.get(content_key("positions", {bytes_of(mesh.vertices)}), [&] {
        return packed(device_, stream_, mesh.vertex_count(), 1,
                      [&](std::size_t v, vec4* out) { *out = texel_of(mesh.vertices[v], 1); });
    });
}

GpuPixelProjection::Shared GpuPixelProjection::scalar_slab(const FeatureMatrix& values,
                                                           std::span<const std::uint32_t> which) {
    std::vector<std::span<const std::byte>> columns;
    for (const std::uint32_t k : which) columns.push_back(std::as_bytes(values.column(k)));
    return kept_.get(content_key("scalars", columns), [&] {
        return packed(device_, stream_, values.rows, k_slab_quads, [&](std::size_t v, vec4* out) {
            std::array<float, k_slab_lanes> lanes{};
            for (std::size_t k = 0; k < which.size(); ++k) lanes[k] = values.column(which[k])[v];
            std::memcpy(out, lanes.data(), sizeof lanes);
        });
    });
}

GpuPixelProjection::Shared GpuPixelProjection::directions_slab(std::span<const std::span<const Vec3>> fields) {
    std::array<std::span<const std::byte>, k_slab_fields> parts{};
    for (std::size_t k = 0; k < fields.size(); ++k) parts[k] = std::as_bytes(fields[k]);
    return kept_.get(content_key("directions", {parts[0], parts[1], parts[2], parts[3]}), [&] {
        return packed(device_, stream_, fields.front().size(), k_slab_fields, [&](std::size_t v, vec4* out) {
            for (std::size_t k = 0; k < k_slab_fields; ++k)
                out[k] = k < fields.size() ? texel_of(fields[k][v], 0) : vec4{};
        });
    });
}

GpuPixelProjection::Shared GpuPixelProjection::curvature_states(const HatchingSurface& surface) {
    const auto of = [](const VertexCurvature& c) {
        return content_key("scale",
                           {bytes_of(c.k1), bytes_of(c.k2), bytes_of(c.e1), bytes_of(c.e2), bytes_of(c.derivative)});
    };
    const std::array<ContentKey, k_hatching_scales.size()> scales{of(surface.curvature[0]), of(surface.curvature[1]),
                                                                  of(surface.curvature[2])};
    const std::array<float, 1> units{surface.unit};
    const ContentKey key = content_key("curvature", {std::as_bytes(std::span(scales)), std::as_bytes(std::span(units)),
                                                     bytes_of(surface.mesh.vertices), bytes_of(surface.normals)});
    return kept_.get(key, [&] {
        const float unit = surface.unit, square = unit * unit;
        return packed(device_, stream_, surface.mesh.vertex_count(), shared::k_curvature_texels,
                      [&](std::size_t v, vec4* out) {
                          *out++ = texel_of(surface.mesh.vertices[v], 1);
                          *out++ = texel_of(surface.normals[v], 0);
                          for (const VertexCurvature& c : surface.curvature) {
                              const auto& d = c.derivative[v];
                              *out++ = texel_of(c.e1[v], c.k1[v] * unit);
                              *out++ = texel_of(c.e2[v], c.k2[v] * unit);
                              *out++ = {d[0] * square, d[1] * square, d[2] * square, d[3] * square};
                          }
                      });
    });
}

/// Records the computation of the slab; its contents are valid when that work has run.
GpuPixelProjection::Shared GpuPixelProjection::curvature_slab(const Buffer& states, const HatchingSurface& surface,
                                                              const HatchingView& view,
                                                              std::span<const std::uint32_t> which) {
    const std::size_t vertices = surface.mesh.vertex_count();
    auto slab = std::make_shared<Buffer>(device_, vertices * k_slab_lanes * sizeof(float));
    for (std::size_t scale = 0; scale < k_hatching_scales.size(); ++scale) {
        ViewCurvatureParameters parameters{.eye = homogeneous_eye(view.camera),
                                           .vertices = 0,
                                           .scale = static_cast<Word>(scale),
                                           .limit = 2 / static_cast<float>(k_hatching_scales[scale]),
                                           .unused = 0,
                                           .columns = {}};
        std::array<std::uint8_t, k_slab_lanes> columns;
        columns.fill(shared::k_other_scale);
        for (std::size_t lane = 0; lane < which.size(); ++lane) {
            if (which[lane] / k_scale_columns == scale)
                columns[lane] = static_cast<std::uint8_t>(which[lane] % k_scale_columns);
        }
        for (std::size_t lane = 0; lane < k_slab_lanes; ++lane)
            parameters.columns[lane / 4] |= Word{columns[lane]} << 8 * (lane % 4);
        const bool some = std::ranges::any_of(columns, [](std::uint8_t c) { return c != shared::k_other_scale; });
        if (some) record_curvature(states, *slab, vertices, parameters);
    }
    return slab;
}

/// Dispatches parts of a size that a kernel can access. They begin at multiples of 64 vertices, which satisfies
/// every device's alignment.
void GpuPixelProjection::record_curvature(const Buffer& states, const Buffer& slab, std::size_t vertices,
                                          const ViewCurvatureParameters& parameters) {
    constexpr std::size_t k_state = shared::k_curvature_texels * sizeof(vec4), k_row = k_slab_lanes * sizeof(float);
    const std::size_t seen = std::min<std::size_t>(buffer_limit(device_.info(), vertices * k_row) / k_row,
                                                   device_.info().max_texels / shared::k_curvature_texels);
    const std::size_t step = std::max<std::size_t>(seen / 64 * 64, 64);
    for (std::size_t first = 0; first < vertices; first += step) {
        ViewCurvatureParameters part = parameters;
        part.vertices = static_cast<Word>(std::min(step, vertices - first));
        stream_.dispatch(view_curvature_, part.vertices,
                         {BufferRange(states, first * k_state, part.vertices * k_state),
                          BufferRange(slab, first * k_row, part.vertices * k_row)},
                         part);
    }
}

// On the host if the device is a CPU (D6 in docs/portability.md): there the kernels take twice as long as the
// reference on the same cores, even without the time to lay out their input.
std::unique_ptr<PixelProjection> projection_for(Device& device) {
    if (device.host_is_faster()) return std::make_unique<CpuPixelProjection>();
    return std::make_unique<GpuPixelProjection>(device);
}

}  // namespace exemplar
