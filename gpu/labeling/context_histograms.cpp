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

// Returns the masses of classes [first, first + count): class blocks x samples, padded to whole sample blocks. The
// lanes beyond the last class and the samples beyond the last are zero.
std::vector<vec4> mass_blocks(const Masses& masses, std::size_t first, std::size_t count) {
    const std::size_t samples = masses.sample_face.size(), row = k_block * sample_blocks(samples);
    std::vector<vec4> blocks(class_blocks(count) * row, vec4{});
    for (std::size_t l = 0; l < count; ++l)
        for (std::size_t j = 0; j < samples; ++j)
            set_lane(blocks[l / k_class_block * row + j], l % k_class_block, static_cast<float>(masses(j, first + l)));
    return blocks;
}

// Returns the prefix sums of the masses in each axis' order, taken in double precision: axes x class blocks x
// (samples + 1).
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

constexpr std::size_t k_pack_faces = 64;

// Packs the ranges from four samples to a face, the first in the lowest byte.
std::uint32_t packed(const std::array<std::array<std::uint8_t, k_pack_faces>, k_block>& ranges, std::size_t sample,
                     std::size_t face) {
    return std::uint32_t{ranges[sample][face]} | std::uint32_t{ranges[sample + 1][face]} << 8 |
           std::uint32_t{ranges[sample + 2][face]} << 16 | std::uint32_t{ranges[sample + 3][face]} << 24;
}

// Packs the ranges from a block of 16 samples to each face, the first in the lowest byte of x. The bytes of missing
// samples do not matter, as these have no mass. Works on local arrays, which cannot overlap, so that compilers
// vectorize; writes device memory in whole runs, as it may be slow.
void pack_ranges(const ContextGeometry& geometry, Range samples, std::size_t first_face, std::span<uvec4> texels) {
    std::array<std::array<std::uint8_t, k_pack_faces>, k_block> ranges{};
    std::array<uvec4, k_pack_faces> some;
    for (std::size_t first = 0; first < texels.size(); first += k_pack_faces) {
        const std::size_t count = std::min(k_pack_faces, texels.size() - first);
        const std::uint8_t* from = geometry.geodesic_bin.data() + samples.first * geometry.faces + first_face + first;
        for (std::size_t j = 0; j < samples.count; ++j)
            std::copy_n(from + j * geometry.faces, count, ranges[j].begin());
        for (std::size_t i = 0; i < k_pack_faces; ++i)
            some[i] = {packed(ranges, 0, i), packed(ranges, 4, i), packed(ranges, 8, i), packed(ranges, 12, i)};
        std::copy_n(some.begin(), count, texels.begin() + static_cast<std::ptrdiff_t>(first));
    }
}

std::size_t histogram_bytes(std::size_t columns, std::size_t classes, std::size_t faces) {
    return columns * classes * faces * sizeof(float);
}

// Returns the maximum samples of a part: the prefix sums of one class block fit the limits, and so do the iterations
// of an invocation, which loops over all samples. It is one less than whole blocks, as there is one more prefix sum
// than samples.
std::size_t samples_per_part(const DeviceInfo& info, std::size_t limit) {
    const std::size_t prefixes = std::min<std::size_t>(limit / sizeof(vec4), info.max_texels);
    const std::size_t samples = std::min<std::size_t>(prefixes / k_context_axes, k_max_iterations);
    return std::max<std::size_t>(samples / k_block, 1) * k_block - 1;
}

// Returns the maximum faces of a part for which the ranges, the positions and the histograms of one class block fit
// the limits.
std::size_t faces_per_part(const DeviceInfo& info, std::size_t limit, std::size_t samples) {
    const std::size_t blocks = sample_blocks(samples);
    const std::size_t by_bytes =
        limit / std::max({blocks * sizeof(uvec4), histogram_bytes(k_columns_per_class, k_class_block, 1),
                          k_context_axes * sizeof(float)});
    const std::size_t by_texels = info.max_texels / std::max(blocks, k_context_axes);
    return std::max<std::size_t>(std::min(by_bytes, by_texels), 1);
}

// Returns the maximum classes of a part for which the histograms and the prefix sums fit the limits.
std::size_t classes_per_part(const DeviceInfo& info, std::size_t limit, std::size_t samples, std::size_t faces) {
    const std::size_t prefixes = k_context_axes * (samples + 1);
    const std::size_t blocks = std::min({limit / histogram_bytes(k_columns_per_class, k_class_block, faces),
                                         limit / (prefixes * sizeof(vec4)), info.max_texels / prefixes});
    return k_class_block * std::max<std::size_t>(blocks, 1);
}

template <typename Use>
void for_each_range(std::size_t count, std::size_t step, Use&& use) {
    for (std::size_t first = 0; first < count; first += step) use(Range{first, std::min(step, count - first)});
}

// Returns the samples' order along each axis, by rising position.
std::vector<std::vector<std::uint32_t>> orders_of(const ContextGeometry& geometry,
                                                  std::span<const std::uint32_t> sample_face) {
    std::vector<std::vector<std::uint32_t>> orders(k_context_axes, std::vector<std::uint32_t>(sample_face.size()));
    for (std::size_t axis = 0; axis < k_context_axes; ++axis) {
        std::iota(orders[axis].begin(), orders[axis].end(), 0u);
        std::ranges::stable_sort(orders[axis], {}, [&](std::uint32_t sample) {
            return geometry.axis_position[axis * geometry.faces + sample_face[sample]];
        });
    }
    return orders;
}

std::vector<float> sorted_positions(const ContextGeometry& geometry, std::span<const std::uint32_t> sample_face,
                                    std::span<const std::vector<std::uint32_t>> orders) {
    std::vector<float> positions;
    for (std::size_t axis = 0; axis < k_context_axes; ++axis)
        for (const std::uint32_t sample : orders[axis])
            positions.push_back(geometry.axis_position[axis * geometry.faces + sample_face[sample]]);
    return positions;
}

// Returns whether `b` directly follows `a`, both on the device and on the host.
bool continues(const BufferReadback& a, const BufferReadback& b) {
    return a.source == b.source && a.offset + a.target.size() == b.offset &&
           a.target.data() + a.target.size() == b.target.data();
}

// Adds a part to fetch, merged with the last one if possible.
void add_fetched(const BufferReadback& part, std::vector<BufferReadback>& parts) {
    if (!parts.empty() && continues(parts.back(), part))
        parts.back().target = {parts.back().target.data(), parts.back().target.size() + part.target.size()};
    else
        parts.push_back(part);
}

}  // namespace

GpuContextHistograms::GpuContextHistograms(Device& device, Profiler* profiler, std::size_t tile_bytes)
    : device_(device),
      tile_bytes_(buffer_limit(device.info(), tile_bytes)),
      faces_per_thread_(device.choose(k_context_faces)),
      stream_(device, profiler),
      geodesic_kernel_(device, shaders::labeling_context_geodesic_comp,
                       {.push_constants = layout_of<GeodesicContextParameters>(),
                        .elements = {layout_of<uvec4>(), layout_of<vec4>(), layout_of<float>()},
                        .constants = {{0, faces_per_thread_}}}),
      axes_kernel_(device, shaders::labeling_context_axes_comp,
                   {.push_constants = layout_of<AxisContextParameters>(),
                    .elements = {layout_of<float>(), layout_of<float>(), layout_of<vec4>(), layout_of<float>()}}) {}

void GpuContextHistograms::accumulate_all(std::span<const ContextMesh> meshes, std::size_t classes) {
    for (const ContextMesh& mesh : meshes) check_context(mesh, classes);
    std::vector<Part> parts;
    for (const ContextMesh& mesh : meshes) {
        if (mesh.geometry->sample_face.empty()) std::ranges::fill(mesh.out, 0.0f);
        add_parts(mesh, classes, parts);
    }
    for (std::span<const Part> left = parts; !left.empty();) {
        const std::size_t count = together(left);
        run(left.first(count));
        left = left.subspan(count);
    }
}

// Parts are in order of samples: the histograms of the first range are written to the output, those of later ranges
// are added.
void GpuContextHistograms::add_parts(const ContextMesh& mesh, std::size_t classes, std::vector<Part>& parts) const {
    const DeviceInfo& info = device_.info();
    const std::size_t all_faces = mesh.geometry->faces;
    for_each_range(mesh.geometry->sample_face.size(), samples_per_part(info, tile_bytes_), [&](Range samples) {
        const std::size_t face_step = std::min(faces_per_part(info, tile_bytes_, samples.count), all_faces);
        const std::size_t class_step = classes_per_part(info, tile_bytes_, samples.count, face_step);
        for_each_range(all_faces, face_step, [&](Range faces) {
            for_each_range(classes, class_step, [&](Range some) {
                parts.push_back({&mesh, classes, samples, faces, some});
            });
        });
    });
}

// Returns how many of the parts, at least one, fit into one submission.
std::size_t GpuContextHistograms::together(std::span<const Part> parts) const {
    std::size_t count = 0, bytes = 0;
    for (const Part& part : parts) {
        bytes += std::max({sample_blocks(part.samples.count) * part.faces.count * sizeof(uvec4),
                           class_blocks(part.classes.count) * k_context_axes * (part.samples.count + 1) * sizeof(vec4),
                           histogram_bytes(k_columns_per_class, part.classes.count, part.faces.count)});
        if (count > 0 && bytes > tile_bytes_) break;
        ++count;
    }
    return count;
}

void GpuContextHistograms::run(std::span<const Part> parts) {
    // Each slot keeps the largest buffers that it ever needed. After many large parts, these would fill the device.
    if (kept_bytes() > 8 * tile_bytes_) slots_.clear();
    if (slots_.size() < parts.size()) slots_.resize(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) reserve_slot(parts[i], slots_[i]);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        upload(parts[i], slots_[i]);
        dispatch(parts[i], slots_[i]);
    }
    fetch(parts);
}

std::size_t GpuContextHistograms::kept_bytes() const {
    std::size_t bytes = 0;
    for (const Slot& slot : slots_)
        for (const Buffer* const buffer :
             {&slot.ranges, &slot.masses, &slot.positions, &slot.sorted, &slot.prefixes, &slot.geodesic, &slot.axes})
            bytes += buffer->bytes();
    return bytes;
}

void GpuContextHistograms::reserve_slot(const Part& part, Slot& slot) {
    const std::size_t samples = part.samples.count, faces = part.faces.count, classes = part.classes.count;
    const std::size_t blocks = class_blocks(classes);
    reserve(device_, slot.ranges, sample_blocks(samples) * faces * sizeof(uvec4));
    reserve(device_, slot.masses, blocks * sample_blocks(samples) * k_block * sizeof(vec4));
    reserve(device_, slot.positions, k_context_axes * faces * sizeof(float));
    reserve(device_, slot.sorted, k_context_axes * samples * sizeof(float));
    reserve(device_, slot.prefixes, k_context_axes * blocks * (samples + 1) * sizeof(vec4));
    reserve(device_, slot.geodesic, histogram_bytes(k_context_bins, classes, faces));
    reserve(device_, slot.axes, histogram_bytes(k_context_axes * k_context_bins, classes, faces));
}

void GpuContextHistograms::upload(const Part& part, Slot& slot) {
    const ContextGeometry& geometry = *part.mesh->geometry;
    const Range samples = part.samples, faces = part.faces;
    const std::size_t range_bytes = sample_blocks(samples.count) * faces.count * sizeof(uvec4);
    stream_.upload_with(slot.ranges, range_bytes, 0, [&](std::span<std::byte> memory) {
        const std::span texels(reinterpret_cast<uvec4*>(memory.data()), memory.size() / sizeof(uvec4));
        parallel_for(sample_blocks(samples.count), [&](std::size_t block) {
            const std::size_t first = k_block * block;
            pack_ranges(geometry, {samples.first + first, std::min(k_block, samples.count - first)}, faces.first,
                        texels.subspan(block * faces.count, faces.count));
        });
    });
    for (std::size_t axis = 0; axis < k_context_axes; ++axis)
        stream_.upload<float>(
            slot.positions, std::span(geometry.axis_position).subspan(axis * geometry.faces + faces.first, faces.count),
            axis * faces.count * sizeof(float));
    const std::span sample_face = std::span(geometry.sample_face).subspan(samples.first, samples.count);
    const std::span sample_area = std::span(geometry.sample_area).subspan(samples.first, samples.count);
    const std::vector<std::vector<std::uint32_t>> orders = orders_of(geometry, sample_face);
    const Masses masses{sample_face, sample_area, part.mesh->probabilities, part.all_classes};
    const auto [first_class, classes] = part.classes;
    stream_.upload<float>(slot.sorted, sorted_positions(geometry, sample_face, orders));
    stream_.upload<vec4>(slot.masses, mass_blocks(masses, first_class, classes));
    stream_.upload<vec4>(slot.prefixes, mass_prefixes(masses, orders, first_class, classes));
}

void GpuContextHistograms::dispatch(const Part& part, const Slot& slot) {
    const auto faces = static_cast<std::uint32_t>(part.faces.count);
    const auto samples = static_cast<std::uint32_t>(part.samples.count);
    const auto classes = static_cast<std::uint32_t>(part.classes.count);
    const auto blocks = static_cast<std::uint32_t>(sample_blocks(samples));
    const std::size_t mass_rows = class_blocks(classes);
    const std::uint32_t threads = (faces + faces_per_thread_ - 1) / faces_per_thread_;
    stream_.dispatch(geodesic_kernel_, Threads(threads, class_blocks(classes)),
                     {BufferRange(slot.ranges, 0, std::size_t{blocks} * faces * sizeof(uvec4)),
                      BufferRange(slot.masses, 0, mass_rows * blocks * k_block * sizeof(vec4)),
                      BufferRange(slot.geodesic, 0, histogram_bytes(k_context_bins, classes, faces))},
                     GeodesicContextParameters{faces, blocks, classes, threads});
    AxisContextParameters axes{.edges = {}, .faces = faces, .samples = samples, .classes = classes, .padding = 0};
    for (std::size_t axis = 0; axis < k_context_axes; ++axis)
        axes.edges[axis] = to_vec4(part.mesh->geometry->axis_edges[axis]);
    stream_.dispatch(axes_kernel_, Threads(faces, k_context_axes),
                     {BufferRange(slot.positions, 0, k_context_axes * faces * sizeof(float)),
                      BufferRange(slot.sorted, 0, k_context_axes * samples * sizeof(float)),
                      BufferRange(slot.prefixes, 0, k_context_axes * mass_rows * (samples + 1) * sizeof(vec4)),
                      BufferRange(slot.axes, 0, histogram_bytes(k_context_axes * k_context_bins, classes, faces))},
                     axes);
}

void GpuContextHistograms::fetch(std::span<const Part> parts) {
    std::size_t later = 0;
    for (const Part& part : parts)
        if (part.samples.first > 0) later += k_columns_per_class * part.classes.count * part.faces.count;
    later_.resize(later);
    struct Sum {
        std::span<float> out;
        std::span<const float> added;
    };
    std::vector<Sum> sums;
    std::vector<BufferReadback> fetched;
    later = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
        for_each_column(parts[i], [&](std::size_t column, std::span<float> out) {
            std::span<float> target = out;
            if (parts[i].samples.first > 0) {
                target = std::span(later_).subspan(later, out.size());
                sums.push_back({out, target});
                later += out.size();
            }
            const std::size_t of_geodesic = k_context_bins * parts[i].classes.count;
            const bool geodesic = column < of_geodesic;
            add_fetched({geodesic ? &slots_[i].geodesic : &slots_[i].axes,
                         (geodesic ? column : column - of_geodesic) * out.size_bytes(), std::as_writable_bytes(target)},
                        fetched);
        });
    stream_.fetch(fetched);
    for (const Sum& sum : sums)
        for (std::size_t f = 0; f < sum.out.size(); ++f) sum.out[f] += sum.added[f];
}

// Calls use(column, out) for the columns of a part's histograms: bins of all measures x classes of the part.
template <typename Use>
void GpuContextHistograms::for_each_column(const Part& part, Use&& use) {
    const std::size_t all_faces = part.mesh->geometry->faces;
    for (std::size_t bin = 0; bin < k_columns_per_class; ++bin)
        for (std::size_t c = 0; c < part.classes.count; ++c) {
            const std::size_t column = bin * part.all_classes + part.classes.first + c;
            use(bin * part.classes.count + c,
                part.mesh->out.subspan(column * all_faces + part.faces.first, part.faces.count));
        }
}

}  // namespace exemplar
