#include "gpu/labeling/context_histograms.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>

#include "embedded/labeling_context_axes_comp.h"
#include "embedded/labeling_context_geodesic_comp.h"
#include "host/core/parallel.h"
#include "shaders/shared/context.h"

namespace exemplar {
namespace {

using Range = GpuContextHistograms::Range;
using shared::AxisContextParameters;
using shared::GeodesicContextParameters;
using shared::uvec4;
using shared::vec4;

constexpr std::size_t k_columns_per_class = k_context_measures * k_context_bins;
constexpr std::size_t k_block = shared::k_context_sample_block;
constexpr std::size_t k_class_block = shared::k_context_class_block;
static_assert(shared::k_context_bins == k_context_bins && shared::k_context_axes == k_context_axes);
// A texel's lanes: the inner bin edges of an axis, and the classes of a block.
static_assert(k_context_bins - 1 == 4 && k_class_block == 4);

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
// place of missing samples does not matter: they have no mass. Each texel is written once, as device memory may be slow
// to read.
void pack_ranges(const ContextGeometry& geometry, Range samples, std::size_t first_face, std::span<uvec4> texels) {
    for (std::size_t i = 0; i < texels.size(); ++i) {
        std::array<std::uint32_t, 4> words{};
        const std::uint8_t* range = geometry.geodesic_bin.data() + samples.first * geometry.faces + first_face + i;
        for (std::size_t j = 0; j < samples.count; ++j)
            words[j / 4] |= std::uint32_t{range[j * geometry.faces]} << (8 * (j % 4));
        texels[i] = {words[0], words[1], words[2], words[3]};
    }
}

std::size_t histogram_bytes(std::size_t faces, std::size_t classes) {
    return k_columns_per_class * classes * faces * sizeof(float);
}

// Samples per pass so that the prefix sums of one class block pass no limit. One less than whole blocks: the prefix
// sums, one more than samples, then are.
std::size_t samples_per_pass(const DeviceInfo& info, std::size_t tile_bytes) {
    const std::size_t prefixes = std::min<std::size_t>(buffer_limit(info, tile_bytes) / sizeof(vec4), info.max_texels);
    return std::max<std::size_t>(prefixes / k_context_axes / k_block, 1) * k_block - 1;
}

// Faces per tile so that neither the ranges nor the positions nor the histograms of one class block pass the limits.
std::size_t faces_per_tile(const DeviceInfo& info, std::size_t tile_bytes, std::size_t samples) {
    const std::size_t limit = buffer_limit(info, tile_bytes), blocks = sample_blocks(samples);
    const std::size_t by_bytes =
        limit / std::max({blocks * sizeof(uvec4), histogram_bytes(1, k_class_block), k_context_axes * sizeof(float)});
    const std::size_t by_texels = info.max_texels / std::max(blocks, k_context_axes);
    return std::max<std::size_t>(std::min(by_bytes, by_texels), 1);
}

template <typename Use>
void for_each_range(std::size_t count, std::size_t step, Use&& use) {
    for (std::size_t first = 0; first < count; first += step) use(Range{first, std::min(step, count - first)});
}

}  // namespace

GpuContextHistograms::Samples::Samples(Device& device, const ContextGeometry& geometry, Range part)
    : range(part),
      face(std::span(geometry.sample_face).subspan(part.first, part.count)),
      area(std::span(geometry.sample_area).subspan(part.first, part.count)) {
    std::vector<float> sorted_positions;
    for (std::size_t axis = 0; axis < k_context_axes; ++axis) {
        const auto position = [&](std::uint32_t sample) {
            return geometry.axis_position[axis * geometry.faces + face[sample]];
        };
        order[axis].resize(part.count);
        std::iota(order[axis].begin(), order[axis].end(), 0u);
        std::ranges::stable_sort(order[axis], {}, position);
        std::ranges::transform(order[axis], std::back_inserter(sorted_positions), position);
    }
    sorted = Buffer::of<float>(device, sorted_positions);
}

GpuContextHistograms::Tile::Tile(Device& device, Stream& stream, const ContextGeometry& geometry, Range samples,
                                 Range part)
    : faces(part),
      ranges(device, sample_blocks(samples.count) * faces.count * sizeof(uvec4)),
      positions(device, k_context_axes * faces.count * sizeof(float)) {
    stream.upload_with(ranges, ranges.bytes(), 0, [&](std::span<std::byte> memory) {
        const std::span texels(reinterpret_cast<uvec4*>(memory.data()), memory.size() / sizeof(uvec4));
        parallel_for(sample_blocks(samples.count), [&](std::size_t block) {
            const std::size_t first = k_block * block;
            pack_ranges(geometry, {samples.first + first, std::min(k_block, samples.count - first)}, faces.first,
                        texels.subspan(block * faces.count, faces.count));
        });
    });
    for (std::size_t axis = 0; axis < k_context_axes; ++axis)
        stream.upload<float>(
            positions, std::span(geometry.axis_position).subspan(axis * geometry.faces + faces.first, faces.count),
            axis * faces.count * sizeof(float));
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
    check_context_geometry(geometry);
    check_context_sizes(geometry.faces, probabilities, classes, out);
    std::ranges::fill(out, 0.0f);
    const Job job{geometry, probabilities, classes, out};
    for_each_range(geometry.sample_face.size(), samples_per_pass(device_.info(), tile_bytes_), [&](Range range) {
        const Samples samples(device_, geometry, range);
        const std::size_t step = std::min(faces_per_tile(device_.info(), tile_bytes_, range.count), geometry.faces);
        const std::vector<ClassChunk> chunks = class_chunks(job, samples, step);
        for_each_range(geometry.faces, step, [&](Range faces) {
            const Tile tile(device_, stream_, geometry, range, faces);
            for (const ClassChunk& chunk : chunks) add_tile(job, samples, tile, chunk);
        });
    });
}

std::vector<GpuContextHistograms::ClassChunk> GpuContextHistograms::class_chunks(const Job& job, const Samples& samples,
                                                                                 std::size_t tile_faces) {
    const std::size_t limit = buffer_limit(device_.info(), tile_bytes_);
    const std::size_t prefixes_per_block = k_context_axes * (samples.range.count + 1);
    const std::size_t most_blocks =
        std::min({limit / histogram_bytes(tile_faces, k_class_block), limit / (prefixes_per_block * sizeof(vec4)),
                  device_.info().max_texels / prefixes_per_block});
    const Masses masses{samples.face, samples.area, job.probabilities, job.classes};
    std::vector<ClassChunk> chunks;
    for_each_range(job.classes, k_class_block * std::max<std::size_t>(most_blocks, 1), [&](Range classes) {
        chunks.push_back(
            {classes, Buffer::of<vec4>(device_, mass_blocks(masses, classes.first, classes.count)),
             Buffer::of<vec4>(device_, mass_prefixes(masses, samples.order, classes.first, classes.count))});
    });
    return chunks;
}

void GpuContextHistograms::add_tile(const Job& job, const Samples& samples, const Tile& tile, const ClassChunk& chunk) {
    const std::size_t bytes = histogram_bytes(tile.faces.count, chunk.classes.count);
    reserve(device_, histograms_, bytes);
    const BufferRange histograms(histograms_, 0, bytes);
    const auto faces = static_cast<std::uint32_t>(tile.faces.count);
    const auto sample_count = static_cast<std::uint32_t>(samples.range.count);
    const auto classes = static_cast<std::uint32_t>(chunk.classes.count);
    const std::uint32_t threads = (faces + faces_per_thread_ - 1) / faces_per_thread_;
    stream_.dispatch(
        geodesic_kernel_, Threads(threads, class_blocks(classes)), {tile.ranges, chunk.masses, histograms},
        GeodesicContextParameters{faces, static_cast<std::uint32_t>(sample_blocks(sample_count)), classes, threads});
    AxisContextParameters axes{.edges = {}, .faces = faces, .samples = sample_count, .classes = classes, .padding = 0};
    for (std::size_t axis = 0; axis < k_context_axes; ++axis) axes.edges[axis] = to_vec4(job.geometry.axis_edges[axis]);
    stream_.dispatch(axes_kernel_, Threads(faces, k_context_axes),
                     {tile.positions, samples.sorted, chunk.prefixes, histograms}, axes);
    tile_.resize(bytes / sizeof(float));
    stream_.fetch(histograms_, std::span(tile_));
    for (std::size_t row = 0; row < tile_.size() / faces; ++row) {
        const std::size_t bin = row / classes, label = chunk.classes.first + row % classes;
        float* out = job.out.data() + (bin * job.classes + label) * job.geometry.faces + tile.faces.first;
        for (std::size_t f = 0; f < faces; ++f) out[f] += tile_[row * faces + f];
    }
}

}  // namespace exemplar
