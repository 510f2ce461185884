#include "gpu/labeling/context_histograms.h"

#include <algorithm>
#include <numeric>

#include "embedded/labeling_context_axes_comp.h"
#include "embedded/labeling_context_geodesic_comp.h"
#include "host/core/errors.h"
#include "host/learn/boosted_stumps.h"
#include "shaders/shared/context.h"

namespace exemplar {
namespace {

using shared::AxisContextParameters;
using shared::GeodesicContextParameters;
using shared::uvec4;
using shared::vec4;

constexpr std::size_t k_columns_per_class = k_context_measures * k_context_bins;
constexpr std::size_t k_block = shared::k_context_sample_block;
constexpr std::size_t k_class_block = 4;

// On a CPU every load of a kernel is expensive, so that a sample, once loaded, serves many faces; a GPU wants many
// invocations.
constexpr std::uint32_t k_faces_on_cpu = 4;

vec4 to_vec4(const std::array<float, k_context_bins - 1>& edges) {
    return {edges[0], edges[1], edges[2], edges[3]};
}

void set_lane(vec4& vector, std::size_t lane, float value) {
    (&vector.x)[lane] = value;
}

// The mass that a sample adds for a class: a_j P(l | j).
struct Masses {
    std::span<const std::uint32_t> sample_face;
    std::span<const float> sample_area;
    std::span<const float> probabilities;
    std::size_t classes;

    double operator()(std::size_t sample, std::size_t label) const {
        return static_cast<double>(sample_area[sample]) *
               static_cast<double>(probabilities[sample_face[sample] * classes + label]);
    }
};

std::size_t sample_blocks(std::size_t samples) {
    return (samples + k_block - 1) / k_block;
}

std::size_t class_blocks(std::size_t classes) {
    return (classes + k_class_block - 1) / k_class_block;
}

// Class blocks x samples, padded to whole sample blocks, of classes [first, first + count); the lanes beyond the last
// class and the samples beyond the last are zero.
std::vector<vec4> mass_blocks(const Masses& masses, std::size_t first, std::size_t count) {
    const std::size_t samples = masses.sample_face.size(), row = k_block * sample_blocks(samples);
    std::vector<vec4> blocks(class_blocks(count) * row, vec4{});
    for (std::size_t l = 0; l < count; ++l)
        for (std::size_t j = 0; j < samples; ++j)
            set_lane(blocks[l / k_class_block * row + j], l % k_class_block, static_cast<float>(masses(j, first + l)));
    return blocks;
}

// Axes x class blocks x (samples + 1): sums of the masses in each axis' order, taken in double precision.
std::vector<vec4> mass_prefixes(const Masses& masses, std::span<const std::vector<std::uint32_t>> orders,
                                std::size_t first, std::size_t count) {
    const std::size_t samples = masses.sample_face.size(), blocks = class_blocks(count);
    std::vector<vec4> prefixes(orders.size() * blocks * (samples + 1), vec4{});
    for (std::size_t axis = 0; axis < orders.size(); ++axis)
        for (std::size_t l = 0; l < count; ++l) {
            vec4* row = prefixes.data() + (axis * blocks + l / k_class_block) * (samples + 1);
            double sum = 0.0;
            for (std::size_t j = 0; j < samples; ++j) {
                sum += masses(orders[axis][j], first + l);
                set_lane(row[j + 1], l % k_class_block, static_cast<float>(sum));
            }
        }
    return prefixes;
}

// One block of samples: the ranges of faces seen from 16 samples, the first in the lowest byte of x. What stands in the
// place of missing samples does not matter: they have no mass.
void pack_ranges(const ContextGeometry& geometry, std::size_t block, std::size_t first_face, std::span<uvec4> texels) {
    std::ranges::fill(texels, uvec4{});
    const std::size_t samples = geometry.sample_face.size();
    for (std::size_t j = k_block * block; j < std::min(samples, k_block * (block + 1)); ++j) {
        const std::size_t word = j % k_block / 4, shift = 8 * (j % 4);
        const std::uint8_t* row = geometry.geodesic_bin.data() + j * geometry.faces + first_face;
        for (std::size_t i = 0; i < texels.size(); ++i) (&texels[i].x)[word] |= std::uint32_t{row[i]} << shift;
    }
}

// Bytes that one of several buffers may take.
std::size_t buffer_limit(const DeviceInfo& info, std::size_t wanted) {
    return std::min<std::size_t>({wanted, info.max_storage_range, info.max_allocation, info.memory / 8});
}

std::size_t histogram_bytes(std::size_t faces, std::size_t classes) {
    return k_columns_per_class * classes * faces * sizeof(float);
}

// Faces per tile so that neither the ranges nor the positions nor the histograms of one class block pass the limits.
std::size_t faces_per_tile(const DeviceInfo& info, std::size_t tile_bytes, std::size_t samples) {
    const std::size_t limit = buffer_limit(info, tile_bytes), blocks = std::max<std::size_t>(sample_blocks(samples), 1);
    const std::size_t by_bytes =
        limit / std::max({blocks * sizeof(uvec4), histogram_bytes(1, k_class_block), k_context_axes * sizeof(float)});
    const std::size_t by_texels = info.max_texels / std::max(blocks, k_context_axes);
    return std::max<std::size_t>(std::min(by_bytes, by_texels), 1);
}

template <typename Make>
void for_each_tile(std::size_t faces, std::size_t tile_faces, Make&& make) {
    for (std::size_t first = 0; first < faces; first += tile_faces) make(first, std::min(tile_faces, faces - first));
}

}  // namespace

DeviceContextSamples::DeviceContextSamples(Device& device, const ContextGeometry& geometry)
    : face_(geometry.sample_face), area_(geometry.sample_area), axis_edges_(geometry.axis_edges) {
    check_context_geometry(geometry);
    std::vector<float> sorted;
    for (std::size_t axis = 0; axis < k_context_axes; ++axis) {
        const auto position = [&](std::uint32_t sample) {
            return geometry.axis_position[axis * geometry.faces + face_[sample]];
        };
        order_[axis].resize(count());
        std::iota(order_[axis].begin(), order_[axis].end(), 0u);
        std::ranges::stable_sort(order_[axis], {}, position);
        std::ranges::transform(order_[axis], std::back_inserter(sorted), position);
    }
    sorted_ = Buffer::of<float>(device, sorted);
}

DeviceContextTile::DeviceContextTile(Device& device, const ContextGeometry& geometry, std::size_t first_face,
                                     std::size_t face_count)
    : first(first_face),
      faces(face_count),
      ranges(device, sample_blocks(geometry.sample_face.size()) * faces * sizeof(uvec4)),
      positions(device, k_context_axes * faces * sizeof(float)) {
    Stream stream(device);
    std::vector<uvec4> texels(faces);
    for (std::size_t block = 0; block < sample_blocks(geometry.sample_face.size()); ++block) {
        pack_ranges(geometry, block, first, texels);
        stream.upload<uvec4>(ranges, texels, block * faces * sizeof(uvec4));
    }
    for (std::size_t axis = 0; axis < k_context_axes; ++axis)
        stream.upload<float>(positions, std::span(geometry.axis_position).subspan(axis * geometry.faces + first, faces),
                             axis * faces * sizeof(float));
    stream.finish();
}

DeviceContextGeometry::DeviceContextGeometry(Device& device, const ContextGeometry& geometry, std::size_t tile_bytes)
    : faces_(geometry.faces), samples_(device, geometry) {
    for_each_tile(faces_, faces_per_tile(device.info(), tile_bytes, samples()),
                  [&](std::size_t first, std::size_t faces) { tiles_.emplace_back(device, geometry, first, faces); });
}

GpuContextHistograms::GpuContextHistograms(Device& device, Profiler* profiler, std::size_t tile_bytes)
    : device_(device),
      tile_bytes_(tile_bytes),
      faces_per_thread_(device.info().type == DeviceType::cpu ? k_faces_on_cpu : 1),
      stream_(device, profiler),
      geodesic_kernel_(device, shaders::labeling_context_geodesic_comp,
                       {.push_constants = layout_of<GeodesicContextParameters>(),
                        .elements = {layout_of<uvec4>(), layout_of<vec4>(), layout_of<float>()},
                        .constants = {{0, faces_per_thread_}}}),
      axes_kernel_(device, shaders::labeling_context_axes_comp,
                   {.push_constants = layout_of<AxisContextParameters>(),
                    .elements = {layout_of<float>(), layout_of<float>(), layout_of<vec4>(), layout_of<float>()}}) {}

void GpuContextHistograms::accumulate(const ContextGeometry& geometry, std::span<const float> probabilities,
                                      std::size_t classes, std::span<float> out) {
    const DeviceContextSamples samples(device_, geometry);
    check_context_sizes(geometry.faces, probabilities, classes, out);
    const std::size_t tile_faces =
        std::min(faces_per_tile(device_.info(), tile_bytes_, samples.count()), geometry.faces);
    const std::vector<ClassChunk> chunks = class_chunks(samples, probabilities, classes, tile_faces);
    for_each_tile(geometry.faces, tile_faces, [&](std::size_t first, std::size_t faces) {
        const DeviceContextTile tile(device_, geometry, first, faces);
        for (const ClassChunk& chunk : chunks) accumulate_tile(samples, tile, chunk, {out, geometry.faces, classes});
    });
}

void GpuContextHistograms::accumulate(const DeviceContextGeometry& geometry, std::span<const float> probabilities,
                                      std::size_t classes, std::span<float> out) {
    check_context_sizes(geometry.faces(), probabilities, classes, out);
    if (geometry.faces() == 0) return;
    const std::vector<ClassChunk> chunks =
        class_chunks(geometry.samples_, probabilities, classes, geometry.tiles_.front().faces);
    for (const DeviceContextTile& tile : geometry.tiles_)
        for (const ClassChunk& chunk : chunks)
            accumulate_tile(geometry.samples_, tile, chunk, {out, geometry.faces(), classes});
}

std::vector<GpuContextHistograms::ClassChunk> GpuContextHistograms::class_chunks(const DeviceContextSamples& samples,
                                                                                 std::span<const float> probabilities,
                                                                                 std::size_t classes,
                                                                                 std::size_t tile_faces) {
    const std::size_t limit = buffer_limit(device_.info(), tile_bytes_);
    const std::size_t prefixes_per_block = k_context_axes * (samples.count() + 1);
    const std::size_t most_blocks =
        std::min({limit / histogram_bytes(std::max<std::size_t>(tile_faces, 1), k_class_block),
                  limit / (prefixes_per_block * sizeof(vec4)), device_.info().max_texels / prefixes_per_block});
    const std::size_t step = k_class_block * std::max<std::size_t>(most_blocks, 1);
    const Masses masses{samples.face_, samples.area_, probabilities, classes};
    std::vector<ClassChunk> chunks;
    for (std::size_t first = 0; first < classes; first += step) {
        const std::size_t count = std::min(step, classes - first);
        chunks.push_back({first, count, Buffer::of<vec4>(device_, mass_blocks(masses, first, count)),
                          Buffer::of<vec4>(device_, mass_prefixes(masses, samples.order_, first, count))});
    }
    return chunks;
}

void GpuContextHistograms::accumulate_tile(const DeviceContextSamples& samples, const DeviceContextTile& tile,
                                           const ClassChunk& chunk, const Output& out) {
    const std::size_t bytes = histogram_bytes(tile.faces, chunk.count);
    if (!histograms_ || histograms_.bytes() < bytes) histograms_ = Buffer(device_, bytes);
    const BufferRange histograms(histograms_, 0, bytes);
    const auto faces = static_cast<std::uint32_t>(tile.faces);
    const auto sample_count = static_cast<std::uint32_t>(samples.count());
    const auto classes = static_cast<std::uint32_t>(chunk.count);
    const std::uint32_t threads = (faces + faces_per_thread_ - 1) / faces_per_thread_;
    stream_.dispatch(
        geodesic_kernel_, Threads(threads, class_blocks(classes)), {tile.ranges, chunk.masses, histograms},
        GeodesicContextParameters{faces, static_cast<std::uint32_t>(sample_blocks(sample_count)), classes, threads});
    AxisContextParameters axes{.edges = {}, .faces = faces, .samples = sample_count, .classes = classes, .padding = 0};
    for (std::size_t axis = 0; axis < k_context_axes; ++axis) axes.edges[axis] = to_vec4(samples.axis_edges_[axis]);
    stream_.dispatch(axes_kernel_, Threads(tile.faces, k_context_axes),
                     {tile.positions, samples.sorted_, chunk.prefixes, histograms}, axes);
    stream_.finish();
    tile_.resize(bytes / sizeof(float));
    histograms_.download<float>(tile_);
    for (std::size_t bin = 0; bin < k_columns_per_class; ++bin)
        for (std::size_t c = 0; c < chunk.count; ++c)
            std::copy_n(tile_.data() + (bin * chunk.count + c) * tile.faces, tile.faces,
                        out.values.data() + (bin * out.classes + chunk.first + c) * out.faces + tile.first);
}

}  // namespace exemplar
