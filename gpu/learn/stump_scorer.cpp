#include "gpu/learn/stump_scorer.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "embedded/learn_stumps_comp.h"
#include "shaders/shared/stumps.h"

namespace exemplar {
namespace {

using shared::GroupedStump;
using shared::StumpGroup;
using shared::StumpParameters;

// The kernel fetches each as one four-component vector.
static_assert(sizeof(GroupedStump) == 16 && sizeof(StumpGroup) == 16);
static_assert(shared::k_link_softmax == static_cast<std::uint32_t>(Link::softmax) &&
              shared::k_link_sigmoid == static_cast<std::uint32_t>(Link::sigmoid));

// On a CPU every load of a kernel is expensive, so that a stump, once loaded, serves many items; a GPU wants many
// invocations.
constexpr std::uint32_t k_quads_on_cpu = 4;

// A classifier as the kernel wants it.
struct GroupedStumps {
    std::vector<std::uint32_t> columns;  // features that are used, by rising number
    std::vector<GroupedStump> stumps;
    std::vector<StumpGroup> groups;
    std::vector<float> constant;
};

std::vector<std::uint32_t> used_features(const BoostedStumps& classifier) {
    std::vector<std::uint32_t> used;
    for (const Stump& stump : classifier.stumps) used.push_back(stump.feature);
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    return used;
}

GroupedStumps group(const BoostedStumps& classifier) {
    GroupedStumps result{
        .columns = used_features(classifier), .stumps = {}, .groups = {}, .constant = classifier.constant()};
    std::vector<Stump> sorted = classifier.stumps;
    std::ranges::stable_sort(sorted, {}, &Stump::classes);
    std::uint64_t last_classes = 0;
    for (const Stump& stump : sorted) {
        const auto index = static_cast<std::uint32_t>(result.stumps.size());
        if (result.groups.empty() || stump.classes != last_classes)
            result.groups.push_back({index, index, static_cast<std::uint32_t>(stump.classes),
                                     static_cast<std::uint32_t>(stump.classes >> 32)});
        last_classes = stump.classes;
        ++result.groups.back().end;
        const auto column = std::ranges::lower_bound(result.columns, stump.feature) - result.columns.begin();
        result.stumps.push_back({static_cast<std::uint32_t>(column), stump.threshold, stump.above, stump.below});
    }
    return result;
}

// Shaders may take NaN and infinity for what never occurs, so none reaches them. The smallest number is above no
// threshold, as NaN; the largest is above all, as infinity.
void copy_finite(std::span<const float> values, std::span<std::byte> memory) {
    constexpr float k_largest = std::numeric_limits<float>::max();
    auto* out = reinterpret_cast<float*>(memory.data());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float above = values[i] > -k_largest ? values[i] : -k_largest;
        out[i] = above < k_largest ? above : k_largest;
    }
}

}  // namespace

GpuStumpScorer::GpuStumpScorer(Device& device, Profiler* profiler, std::size_t tile_bytes)
    : device_(device),
      quads_(device.info().type == DeviceType::cpu ? k_quads_on_cpu : 1),
      tile_bytes_(buffer_limit(device.info(), tile_bytes)),
      stream_(device, profiler) {}

// Rows of the smallest tile: neighboring invocations work side by side.
std::size_t GpuStumpScorer::tile_unit() const {
    return std::size_t{4} * quads_ * shared::k_stump_neighbors;
}

// A multiple of tile_unit(), so that neither features nor probabilities pass the limits.
std::size_t GpuStumpScorer::rows_per_tile(std::size_t rows, std::size_t columns, std::size_t classes) const {
    const std::size_t unit = tile_unit();
    const std::size_t feature_bytes = std::min<std::size_t>(tile_bytes_, 16 * device_.info().max_texels);
    const std::size_t most = std::min(feature_bytes / (std::max<std::size_t>(columns, 1) * sizeof(float)),
                                      tile_bytes_ / (classes * sizeof(float)));
    return std::min(std::max(most / unit * unit, unit), (rows + unit - 1) / unit * unit);
}

const Kernel& GpuStumpScorer::kernel(std::uint32_t classes) {
    Kernel& kernel = kernels_[classes];
    if (!kernel)
        kernel = Kernel(device_, shaders::learn_stumps_comp,
                        {.push_constants = layout_of<StumpParameters>(),
                         .elements = {layout_of<shared::vec4>(), layout_of<shared::uvec4>(), layout_of<shared::uvec4>(),
                                      layout_of<float>(), layout_of<float>()},
                         .constants = {{0, classes}, {1, quads_}}});
    return kernel;
}

void GpuStumpScorer::probabilities(const BoostedStumps& classifier, const FeatureMatrix& features, Link link,
                                   float scale, std::span<float> out) {
    check_scoring(classifier, features, scale, out);
    if (features.rows == 0) return;
    const std::size_t classes = classifier.class_count;
    const GroupedStumps grouped = group(classifier);
    const Buffer stumps = Buffer::of<GroupedStump>(device_, grouped.stumps);
    const Buffer groups = Buffer::of<StumpGroup>(device_, grouped.groups);
    const Buffer constant = Buffer::of<float>(device_, grouped.constant);

    const std::size_t tile_rows = rows_per_tile(features.rows, grouped.columns.size(), classes);
    const std::size_t column_bytes = tile_rows * sizeof(float);
    reserve(device_, features_, grouped.columns.size() * column_bytes);
    reserve(device_, probabilities_, tile_rows * classes * sizeof(float));
    for (std::size_t first = 0; first < features.rows; first += tile_rows) {
        const std::size_t rows = std::min(tile_rows, features.rows - first);
        for (std::size_t c = 0; c < grouped.columns.size(); ++c)
            stream_.upload_with(features_, rows * sizeof(float), c * column_bytes, [&](std::span<std::byte> memory) {
                copy_finite(features.column(grouped.columns[c]).subspan(first, rows), memory);
            });
        const std::size_t threads = (rows + tile_unit() - 1) / tile_unit() * shared::k_stump_neighbors;
        const StumpParameters parameters{.rows = static_cast<std::uint32_t>(rows),
                                         .stride = static_cast<std::uint32_t>(tile_rows / 4),
                                         .threads = static_cast<std::uint32_t>(threads),
                                         .groups = static_cast<std::uint32_t>(grouped.groups.size()),
                                         .link = static_cast<std::uint32_t>(link),
                                         .scale = scale};
        stream_.dispatch(kernel(classifier.class_count), threads,
                         {BufferRange(features_, 0, grouped.columns.size() * column_bytes), stumps, groups, constant,
                          BufferRange(probabilities_, 0, tile_rows * classes * sizeof(float))},
                         parameters);
        stream_.fetch(probabilities_, out.subspan(first * classes, rows * classes));
    }
}

}  // namespace exemplar
