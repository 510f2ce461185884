#include "gpu/learn/stump_scorer.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "embedded/learn_stumps_comp.h"
#include "host/core/errors.h"
#include "shaders/shared/stumps.h"

namespace exemplar {
namespace {

using shared::GroupedStump;
using shared::StumpGroup;
using shared::StumpParameters;

// The kernel fetches each as one four-component vector.
static_assert(sizeof(GroupedStump) == 16 && sizeof(StumpGroup) == 16);

// On a CPU every load of a kernel is expensive, so that a stump, once loaded, serves many items; a GPU wants many
// invocations.
constexpr std::uint32_t k_quads_on_cpu = 2;

// A classifier as the kernel wants it.
struct GroupedStumps {
    std::vector<std::uint32_t> columns;  // features that are used, by rising number
    std::vector<GroupedStump> stumps;
    std::vector<StumpGroup> groups;
    std::vector<float> constant;
};

void check(const BoostedStumps& classifier, const FeatureMatrix& features, float scale, std::span<const float> out) {
    const std::size_t classes = classifier.class_count;
    if (classes == 0 || classes > k_max_classes)
        throw ModelError(fmt::format("the classifier has {} classes, but 1 to {} are possible; train it again", classes,
                                     k_max_classes));
    if (classifier.elsewhere.size() != classifier.stumps.size() * classes)
        throw ModelError("the classifier does not have one constant k_c per stump and class; train it again");
    for (const Stump& stump : classifier.stumps) {
        if (stump.feature >= features.cols())
            throw ModelError(
                fmt::format("a stump needs feature {}, but there are {}; use the features it was trained on",
                            stump.feature, features.cols()));
        if (classes < 64 && (stump.classes >> classes) != 0)
            throw ModelError(
                fmt::format("a stump is shared by a class beyond the classifier's {}; train it again", classes));
    }
    if (out.size() != features.rows * classes)
        throw UsageError(fmt::format("the output holds {} values, but {} rows x {} classes are needed", out.size(),
                                     features.rows, classes));
    if (!(scale > 0.0f)) throw UsageError(fmt::format("the link's scale is {}; it must be above zero", scale));
}

std::vector<std::uint32_t> used_features(const BoostedStumps& classifier) {
    std::vector<std::uint32_t> used;
    for (const Stump& stump : classifier.stumps) used.push_back(stump.feature);
    std::ranges::sort(used);
    used.erase(std::ranges::unique(used).begin(), used.end());
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

void reserve(Device& device, Buffer& buffer, std::size_t bytes) {
    if (!buffer || buffer.bytes() < bytes) buffer = Buffer(device, bytes);
}

// Rows per tile, a multiple of `unit`, so that neither features nor probabilities pass the limit.
std::size_t rows_per_tile(std::size_t limit, std::size_t columns, std::size_t classes, std::size_t unit) {
    const std::size_t row_bytes = std::max({columns, classes, std::size_t{1}}) * sizeof(float);
    return std::max<std::size_t>(limit / row_bytes / unit * unit, unit);
}

}  // namespace

GpuStumpScorer::GpuStumpScorer(Device& device, Profiler* profiler, std::size_t tile_bytes)
    : device_(device),
      quads_(device.info().type == DeviceType::cpu ? k_quads_on_cpu : 1),
      tile_bytes_(std::min<std::size_t>({tile_bytes, device.info().max_storage_range, device.info().max_allocation})),
      stream_(device, profiler) {}

const Kernel& GpuStumpScorer::kernel(std::uint32_t classes) {
    Kernel& kernel = kernels_[classes];
    if (!kernel)
        kernel = Kernel(device_, shaders::learn_stumps_comp,
                        {.push_constants = layout_of<StumpParameters>(),
                         .elements = {layout_of<shared::vec4>(), layout_of<shared::vec4>(), layout_of<shared::uvec4>(),
                                      layout_of<float>(), layout_of<float>()},
                         .constants = {{0, classes}, {1, quads_}}});
    return kernel;
}

void GpuStumpScorer::probabilities(const BoostedStumps& classifier, const FeatureMatrix& features, Link link,
                                   float scale, std::span<float> out) {
    check(classifier, features, scale, out);
    if (features.rows == 0) return;
    const std::size_t classes = classifier.class_count;
    const GroupedStumps grouped = group(classifier);
    const Buffer stumps = Buffer::of<GroupedStump>(device_, grouped.stumps);
    const Buffer groups = Buffer::of<StumpGroup>(device_, grouped.groups);
    const Buffer constant = Buffer::of<float>(device_, grouped.constant);

    const std::size_t unit = std::size_t{4} * quads_;  // items per invocation
    const std::size_t tile_rows = std::min(rows_per_tile(tile_bytes_, grouped.columns.size(), classes, unit),
                                           (features.rows + unit - 1) / unit * unit);
    const std::size_t column_bytes = tile_rows * sizeof(float);
    reserve(device_, features_, grouped.columns.size() * column_bytes);
    reserve(device_, probabilities_, tile_rows * classes * sizeof(float));
    for (std::size_t first = 0; first < features.rows; first += tile_rows) {
        const std::size_t rows = std::min(tile_rows, features.rows - first);
        for (std::size_t c = 0; c < grouped.columns.size(); ++c)
            stream_.upload<float>(features_, features.column(grouped.columns[c]).subspan(first, rows),
                                  c * column_bytes);
        const std::size_t threads = (rows + unit - 1) / unit;
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
        stream_.finish();
        probabilities_.download(out.subspan(first * classes, rows * classes));
    }
}

}  // namespace exemplar
