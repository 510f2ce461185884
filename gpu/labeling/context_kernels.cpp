#include "gpu/labeling/context_kernels.h"

#include <algorithm>
#include <numeric>

#include "embedded/labeling_context_axes_comp.h"
#include "embedded/labeling_context_geodesic_comp.h"
#include "embedded/labeling_context_masses_comp.h"
#include "embedded/labeling_context_prefixes_comp.h"
#include "host/core/parallel.h"
#include "shaders/shared/context.h"

namespace exemplar {
namespace {

using shared::ContextPart;
using shared::ContextSample;
using shared::MassParameters;
using shared::uvec4;
using shared::vec4;

static_assert(k_class_block == shared::k_context_class_block && k_sample_block == shared::k_context_sample_block);
static_assert(shared::k_context_bins == k_context_bins && shared::k_context_axes == k_context_axes);
// A texel's lanes: the inner bin edges of an axis, and the classes of a block.
static_assert(k_context_bins - 1 == 4 && k_class_block == 4);

constexpr std::uint32_t k_range_bits = 4, k_range_mask = (1U << k_range_bits) - 1;
constexpr std::size_t k_ranges_of_word = 32 / k_range_bits;
static_assert((k_no_bin & k_range_mask) >= k_context_bins && 4 * k_ranges_of_word == k_sample_block);

std::size_t sample_blocks(std::size_t samples) {
    return (samples + k_sample_block - 1) / k_sample_block;
}

std::size_t class_blocks(std::size_t classes) {
    return (classes + k_class_block - 1) / k_class_block;
}

std::uint32_t to_uint(std::size_t value) {
    return static_cast<std::uint32_t>(value);
}

constexpr std::size_t k_pack_faces = 64;

// Packs the ranges from a block of 32 samples to each face, the first in the lowest bits of x. Those of missing samples
// do not matter, as these have no mass. Works on local arrays, which cannot overlap, so that compilers vectorize;
// writes device memory in whole runs, as it may be slow.
void pack_ranges(const ContextGeometry& geometry, ContextRange samples, std::size_t first_face,
                 std::span<uvec4> texels) {
    std::array<std::array<std::uint32_t, k_pack_faces>, k_sample_block / k_ranges_of_word> words;
    std::array<std::uint8_t, k_pack_faces> ranges{};
    std::array<uvec4, k_pack_faces> some;
    for (std::size_t first = 0; first < texels.size(); first += k_pack_faces) {
        const std::size_t count = std::min(k_pack_faces, texels.size() - first);
        const std::uint8_t* from = geometry.geodesic_bin.data() + samples.first * geometry.faces + first_face + first;
        words = {};
        for (std::size_t j = 0; j < samples.count; ++j) {
            std::copy_n(from + j * geometry.faces, count, ranges.begin());
            std::array<std::uint32_t, k_pack_faces>& word = words[j / k_ranges_of_word];
            const std::uint32_t shift = k_range_bits * to_uint(j % k_ranges_of_word);
            for (std::size_t i = 0; i < k_pack_faces; ++i) word[i] |= (ranges[i] & k_range_mask) << shift;
        }
        for (std::size_t i = 0; i < k_pack_faces; ++i) some[i] = {words[0][i], words[1][i], words[2][i], words[3][i]};
        std::copy_n(some.begin(), count, texels.begin() + static_cast<std::ptrdiff_t>(first));
    }
}

std::span<const std::uint32_t> faces_of_samples(const ContextWork& work) {
    return std::span(work.geometry->sample_face).subspan(work.samples.first, work.samples.count);
}

// Returns the samples' order along an axis, by rising position.
std::vector<std::uint32_t> order_along(const ContextWork& work, std::size_t axis) {
    const std::span<const std::uint32_t> sample_face = faces_of_samples(work);
    const float* position = work.geometry->axis_position.data() + axis * work.geometry->faces;
    std::vector<std::uint32_t> order(sample_face.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t sample) { return position[sample_face[sample]]; });
    return order;
}

}  // namespace

ContextDemand demand_of(std::size_t samples, std::size_t faces, std::size_t classes) {
    const std::size_t ranges = sample_blocks(samples) * faces;
    const std::size_t prefixes = k_context_axes * class_blocks(classes) * (samples + 1);
    const std::size_t masses = class_blocks(classes) * sample_blocks(samples) * k_sample_block;
    const std::size_t histograms = k_context_axes * k_context_bins * classes * faces;
    return {
        std::max({ranges * sizeof(uvec4), prefixes * sizeof(vec4), masses * sizeof(vec4), histograms * sizeof(float)}),
        std::max({ranges, prefixes, masses, k_context_axes * std::max(faces, samples)})};
}

ContextKernels::ContextKernels(Device& device)
    : device_(device),
      faces_per_thread_(device.choose(k_context_faces)),
      mass_kernel_(
          device, shaders::labeling_context_masses_comp,
          {.push_constants = layout_of<MassParameters>(),
           .elements = {layout_of<ContextPart>(), layout_of<ContextSample>(), layout_of<float>(), layout_of<vec4>()}}),
      prefix_kernel_(
          device, shaders::labeling_context_prefixes_comp,
          {.elements = {layout_of<ContextPart>(), layout_of<std::uint32_t>(), layout_of<vec4>(), layout_of<vec4>()}}),
      geodesic_kernel_(
          device, shaders::labeling_context_geodesic_comp,
          {.elements = {layout_of<ContextPart>(), layout_of<uvec4>(), layout_of<vec4>(), layout_of<float>()},
           .constants = {{0, faces_per_thread_}}}),
      axes_kernel_(device, shaders::labeling_context_axes_comp,
                   {.elements = {layout_of<ContextPart>(), layout_of<float>(), layout_of<float>(), layout_of<vec4>(),
                                 layout_of<float>()}}) {}

void ContextKernels::release() {
    for (Buffer* const buffer : {&parts_, &ranges_of_, &positions_, &sample_rows_, &sorted_, &orders_, &masses_,
                                 &prefixes_, &geodesic_, &axes_})
        *buffer = {};
}

void ContextKernels::upload(Stream& stream, std::span<const ContextWork> works, std::size_t geodesic_floats) {
    works_ = works.size();
    max_faces_ = max_samples_ = max_classes_ = faces_ = samples_ = ranges_ = 0;
    std::size_t masses = 0, prefixes = 0;
    std::vector<ContextPart> parts;
    parts.reserve(works.size());
    for (const ContextWork& work : works) {
        const std::size_t samples = work.samples.count, faces = work.faces.count, classes = work.classes.count;
        ContextPart part{.edges = {},
                         .faces = to_uint(faces),
                         .samples = to_uint(samples),
                         .classes = to_uint(classes),
                         .first_class = to_uint(work.classes.first),
                         .first_face = to_uint(faces_),
                         .first_sample = to_uint(samples_),
                         .ranges = to_uint(ranges_),
                         .masses = to_uint(masses),
                         .prefixes = to_uint(prefixes),
                         .first_geodesic = to_uint(work.first_geodesic),
                         .first_axes = to_uint(work.first_axes),
                         .stride = to_uint(work.stride)};
        for (std::size_t axis = 0; axis < k_context_axes; ++axis) {
            const std::array<float, k_context_bins - 1>& edges = work.geometry->axis_edges[axis];
            part.edges[axis] = {edges[0], edges[1], edges[2], edges[3]};
        }
        parts.push_back(part);
        max_faces_ = std::max(max_faces_, faces);
        max_samples_ = std::max(max_samples_, samples);
        max_classes_ = std::max(max_classes_, classes);
        faces_ += faces;
        samples_ += samples;
        ranges_ += sample_blocks(samples) * faces;
        masses += class_blocks(classes) * sample_blocks(samples) * k_sample_block;
        prefixes += k_context_axes * class_blocks(classes) * (samples + 1);
    }
    reserve(device_, parts_, parts.size() * sizeof(ContextPart));
    reserve(device_, masses_, masses * sizeof(vec4));
    reserve(device_, prefixes_, prefixes * sizeof(vec4));
    reserve(device_, geodesic_, geodesic_floats * sizeof(float));
    reserve(device_, axes_, k_context_axes * geodesic_floats * sizeof(float));
    stream.upload<ContextPart>(parts_, parts);
    upload_ranges(stream, works);
    upload_positions(stream, works);
    upload_samples(stream, works);
}

void ContextKernels::upload_ranges(Stream& stream, std::span<const ContextWork> works) {
    const std::size_t bytes = ranges_ * sizeof(uvec4);
    reserve(device_, ranges_of_, bytes);
    stream.upload_with(ranges_of_, bytes, 0, [&](std::span<std::byte> memory) {
        std::span texels(reinterpret_cast<uvec4*>(memory.data()), ranges_);
        for (const ContextWork& work : works) {
            const std::size_t blocks = sample_blocks(work.samples.count), faces = work.faces.count;
            parallel_for(blocks, [&](std::size_t block) {
                const std::size_t first = k_sample_block * block;
                pack_ranges(*work.geometry,
                            {work.samples.first + first, std::min(k_sample_block, work.samples.count - first)},
                            work.faces.first, texels.subspan(block * faces, faces));
            });
            texels = texels.subspan(blocks * faces);
        }
    });
}

void ContextKernels::upload_positions(Stream& stream, std::span<const ContextWork> works) {
    const std::size_t bytes = k_context_axes * faces_ * sizeof(float);
    reserve(device_, positions_, bytes);
    stream.upload_with(positions_, bytes, 0, [&](std::span<std::byte> memory) {
        auto* to = reinterpret_cast<float*>(memory.data());
        for (const ContextWork& work : works)
            for (std::size_t axis = 0; axis < k_context_axes; ++axis)
                to = std::copy_n(work.geometry->axis_position.data() + axis * work.geometry->faces + work.faces.first,
                                 work.faces.count, to);
    });
}

void ContextKernels::upload_samples(Stream& stream, std::span<const ContextWork> works) {
    std::vector<ContextSample> samples;
    std::vector<std::uint32_t> orders;
    std::vector<float> sorted;
    samples.reserve(samples_);
    orders.reserve(k_context_axes * samples_);
    sorted.reserve(k_context_axes * samples_);
    for (const ContextWork& work : works) {
        for (std::size_t j = 0; j < work.samples.count; ++j)
            samples.push_back({work.rows[j], work.geometry->sample_area[work.samples.first + j]});
        const std::span<const std::uint32_t> sample_face = faces_of_samples(work);
        for (std::size_t axis = 0; axis < k_context_axes; ++axis)
            for (const std::uint32_t sample : order_along(work, axis)) {
                orders.push_back(sample);
                sorted.push_back(work.geometry->axis_position[axis * work.geometry->faces + sample_face[sample]]);
            }
    }
    reserve(device_, sample_rows_, samples.size() * sizeof(ContextSample));
    reserve(device_, orders_, orders.size() * sizeof(std::uint32_t));
    reserve(device_, sorted_, sorted.size() * sizeof(float));
    stream.upload<ContextSample>(sample_rows_, samples);
    stream.upload<std::uint32_t>(orders_, orders);
    stream.upload<float>(sorted_, sorted);
}

void ContextKernels::record(Stream& stream, const Buffer& probabilities, std::size_t all_classes) {
    const std::size_t blocks = class_blocks(max_classes_);
    stream.dispatch(mass_kernel_, Threads(k_sample_block * sample_blocks(max_samples_), blocks, works_),
                    {parts_, sample_rows_, probabilities, masses_}, MassParameters{to_uint(all_classes)});
    stream.dispatch(prefix_kernel_, Threads(shared::k_prefix_runs * k_context_axes, blocks, works_),
                    {parts_, orders_, masses_, prefixes_});
    stream.dispatch(geodesic_kernel_, Threads((max_faces_ + faces_per_thread_ - 1) / faces_per_thread_, blocks, works_),
                    {parts_, ranges_of_, masses_, geodesic_});
    stream.dispatch(axes_kernel_, Threads(max_faces_, k_context_axes, works_),
                    {parts_, positions_, sorted_, prefixes_, axes_});
}

}  // namespace exemplar
