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
using shared::vec4;

constexpr std::size_t k_columns_per_class = k_context_measures * k_context_bins;

// On a CPU every load of a kernel is expensive, so that a sample, once loaded, serves many faces; a GPU wants many
// invocations.
constexpr std::uint32_t k_faces_on_cpu = 2;

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

std::size_t quads(std::size_t samples) {
    return (samples + 3) / 4;
}

// Class blocks x samples, padded to whole quads; the lanes beyond the last class and the samples beyond the last are
// zero.
std::vector<vec4> mass_blocks(const Masses& masses, std::size_t samples) {
    const std::size_t row = 4 * quads(samples);
    std::vector<vec4> blocks((masses.classes + 3) / 4 * row, vec4{});
    for (std::size_t l = 0; l < masses.classes; ++l)
        for (std::size_t j = 0; j < samples; ++j)
            set_lane(blocks[l / 4 * row + j], l % 4, static_cast<float>(masses(j, l)));
    return blocks;
}

// One quad of samples: the ranges of each of the tile's faces seen from four samples, the first in the lowest byte.
// What stands in the place of missing samples does not matter: they have no mass.
void pack_ranges(const ContextGeometry& geometry, std::size_t quad, std::size_t first_face,
                 std::span<std::uint32_t> words) {
    const std::size_t samples = geometry.sample_face.size();
    std::ranges::fill(words, 0u);
    for (std::size_t j = 4 * quad; j < std::min(samples, 4 * quad + 4); ++j) {
        const std::size_t shift = 8 * (j % 4);
        const std::uint8_t* row = geometry.geodesic_bin.data() + j * geometry.faces + first_face;
        for (std::size_t i = 0; i < words.size(); ++i) words[i] |= static_cast<std::uint32_t>(row[i]) << shift;
    }
}

// Axes x class blocks x (samples + 1): sums of the masses in each axis' order, taken in double precision.
std::vector<vec4> mass_prefixes(const Masses& masses, std::span<const std::vector<std::uint32_t>> orders,
                                std::size_t samples) {
    const std::size_t blocks = (masses.classes + 3) / 4;
    std::vector<vec4> prefixes(orders.size() * blocks * (samples + 1), vec4{});
    for (std::size_t axis = 0; axis < orders.size(); ++axis)
        for (std::size_t l = 0; l < masses.classes; ++l) {
            vec4* row = prefixes.data() + (axis * blocks + l / 4) * (samples + 1);
            double sum = 0.0;
            for (std::size_t j = 0; j < samples; ++j) {
                sum += masses(orders[axis][j], l);
                set_lane(row[j + 1], l % 4, static_cast<float>(sum));
            }
        }
    return prefixes;
}

// Faces per tile so that neither the ranges nor the histograms of the most classes pass the limit.
std::size_t faces_per_tile(std::size_t limit, std::size_t samples) {
    return std::max<std::size_t>(
        limit / (std::max(quads(samples), k_columns_per_class * k_max_classes) * sizeof(float)), 1);
}

}  // namespace

DeviceContextGeometry::DeviceContextGeometry(Device& device, const ContextGeometry& geometry, std::size_t tile_bytes)
    : faces_(geometry.faces),
      sample_face_(geometry.sample_face),
      sample_area_(geometry.sample_area),
      axis_edges_(geometry.axis_edges) {
    check_context_geometry(geometry);
    sort_samples(device, geometry);
    const std::size_t limit =
        std::min<std::size_t>({tile_bytes, device.info().max_storage_range, device.info().max_allocation});
    const std::size_t tile_faces = faces_per_tile(limit, samples());
    for (std::size_t first = 0; first < faces_; first += tile_faces)
        add_tile(device, geometry, first, std::min(tile_faces, faces_ - first));
}

void DeviceContextGeometry::sort_samples(Device& device, const ContextGeometry& geometry) {
    std::vector<float> sorted;
    for (std::size_t axis = 0; axis < k_context_axes; ++axis) {
        const auto position = [&](std::uint32_t sample) {
            return geometry.axis_position[axis * geometry.faces + geometry.sample_face[sample]];
        };
        order_[axis].resize(samples());
        std::iota(order_[axis].begin(), order_[axis].end(), 0u);
        std::ranges::stable_sort(order_[axis], {}, position);
        std::ranges::transform(order_[axis], std::back_inserter(sorted), position);
    }
    sorted_ = Buffer::of<float>(device, sorted);
}

void DeviceContextGeometry::add_tile(Device& device, const ContextGeometry& geometry, std::size_t first,
                                     std::size_t faces) {
    const std::size_t row_bytes = faces * sizeof(float);
    Tile tile{first, faces, Buffer(device, quads(samples()) * row_bytes), Buffer(device, k_context_axes * row_bytes)};
    Stream stream(device);
    std::vector<std::uint32_t> words(faces);
    for (std::size_t quad = 0; quad < quads(samples()); ++quad) {
        pack_ranges(geometry, quad, first, words);
        stream.upload<std::uint32_t>(tile.ranges, words, quad * row_bytes);
    }
    for (std::size_t axis = 0; axis < k_context_axes; ++axis)
        stream.upload<float>(tile.positions, std::span(geometry.axis_position).subspan(axis * faces_ + first, faces),
                             axis * row_bytes);
    stream.finish();
    tiles_.push_back(std::move(tile));
}

GpuContextHistograms::GpuContextHistograms(Device& device, Profiler* profiler)
    : device_(device),
      faces_per_thread_(device.info().type == DeviceType::cpu ? k_faces_on_cpu : 1),
      stream_(device, profiler),
      geodesic_kernel_(device, shaders::labeling_context_geodesic_comp,
                       {.push_constants = layout_of<GeodesicContextParameters>(),
                        .elements = {layout_of<std::uint32_t>(), layout_of<vec4>(), layout_of<float>()},
                        .constants = {{0, faces_per_thread_}}}),
      axes_kernel_(device, shaders::labeling_context_axes_comp,
                   {.push_constants = layout_of<AxisContextParameters>(),
                    .elements = {layout_of<float>(), layout_of<float>(), layout_of<vec4>(), layout_of<float>()}}) {}

void GpuContextHistograms::accumulate(const ContextGeometry& geometry, std::span<const float> probabilities,
                                      std::size_t classes, std::span<float> out) {
    accumulate(DeviceContextGeometry(device_, geometry), probabilities, classes, out);
}

void GpuContextHistograms::accumulate(const DeviceContextGeometry& geometry, std::span<const float> probabilities,
                                      std::size_t classes, std::span<float> out) {
    check_context_sizes(geometry.faces(), probabilities, classes, out);
    if (classes > k_max_classes) throw UsageError("contextual histograms are limited to 64 classes");
    const Masses mass{geometry.sample_face_, geometry.sample_area_, probabilities, classes};
    const Buffer masses = Buffer::of<vec4>(device_, mass_blocks(mass, geometry.samples()));
    const Buffer prefixes = Buffer::of<vec4>(device_, mass_prefixes(mass, geometry.order_, geometry.samples()));
    for (const DeviceContextGeometry::Tile& tile : geometry.tiles_)
        accumulate_tile(geometry, tile, classes, masses, prefixes, out);
}

void GpuContextHistograms::accumulate_tile(const DeviceContextGeometry& geometry,
                                           const DeviceContextGeometry::Tile& tile, std::size_t classes,
                                           const Buffer& masses, const Buffer& prefixes, std::span<float> out) {
    const std::size_t columns = k_columns_per_class * classes;
    const std::size_t bytes = columns * tile.faces * sizeof(float);
    if (!histograms_ || histograms_.bytes() < bytes) histograms_ = Buffer(device_, bytes);
    const BufferRange histograms(histograms_, 0, bytes);
    const auto faces = static_cast<std::uint32_t>(tile.faces);
    const auto samples = static_cast<std::uint32_t>(geometry.samples());
    const auto class_count = static_cast<std::uint32_t>(classes);
    const std::uint32_t threads = (faces + faces_per_thread_ - 1) / faces_per_thread_;
    stream_.dispatch(
        geodesic_kernel_, Threads(threads, (classes + 3) / 4), {tile.ranges, masses, histograms},
        GeodesicContextParameters{faces, static_cast<std::uint32_t>(quads(samples)), class_count, threads});
    AxisContextParameters axes{.edges = {}, .faces = faces, .samples = samples, .classes = class_count, .padding = 0};
    for (std::size_t axis = 0; axis < k_context_axes; ++axis) axes.edges[axis] = to_vec4(geometry.axis_edges_[axis]);
    stream_.dispatch(axes_kernel_, Threads(tile.faces, k_context_axes),
                     {tile.positions, geometry.sorted_, prefixes, histograms}, axes);
    stream_.finish();
    tile_.resize(columns * tile.faces);
    histograms_.download<float>(tile_);
    for (std::size_t column = 0; column < columns; ++column)
        std::copy_n(tile_.data() + column * tile.faces, tile.faces,
                    out.data() + column * geometry.faces() + tile.first);
}

}  // namespace exemplar
