#include "gpu/learn/stump_scorer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "embedded/learn_stumps_comp.h"
#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/learn/boosting/grouped_stumps.h"
#include "host/learn/boosting/threshold_ranks.h"
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

constexpr std::uint32_t k_float_bits = 32, k_rank_bits = 8;
// Ranks have their highest bit flipped, so that they are in order as signed numbers, which devices compare faster.
constexpr std::uint32_t k_sign_bit = 0x80000000;
// Distances of columns on the device are multiples of the largest group of items that invocations read together.
static_assert(k_stump_stride == std::size_t{4} * k_stump_quad_counts.back() * shared::k_stump_neighbors);

// Groups of stumps [first, end).
struct GroupRange {
    std::uint32_t first, end;
};

// A classifier in the kernel's layout.
struct DeviceStumps {
    std::vector<FeatureThresholds> columns;  // features that are used, by rising number
    std::uint32_t bits;                      // of a feature
    std::vector<GroupedStump> stumps;
    std::vector<StumpGroup> groups;
    std::vector<GroupRange> parts;  // of the groups: a dispatch each
    std::vector<float> constant;
};

// Iterations of the kernel's loops for a group: its own, two words of classes, its classes and its stumps.
std::uint32_t iterations_of(const StumpGroup& group) {
    return 3 + static_cast<std::uint32_t>(std::popcount(group.classes_low) + std::popcount(group.classes_high)) +
           group.end - group.first;
}

// Splits a group into several that are small enough for a dispatch.
void add_group(StumpGroup group, std::vector<StumpGroup>& groups) {
    constexpr std::uint32_t k_most = k_max_iterations / 2;
    const std::uint32_t end = group.end;
    for (; end - group.first > k_most; group.first += k_most) {
        group.end = group.first + k_most;
        groups.push_back(group);
    }
    group.end = end;
    groups.push_back(group);
}

std::vector<GroupRange> parts_of(std::span<const StumpGroup> groups) {
    std::vector<GroupRange> parts{{0, 0}};
    std::uint32_t iterations = 0;
    for (const StumpGroup& group : groups) {
        const std::uint32_t more = iterations_of(group);
        if (iterations + more > k_max_iterations) {
            parts.push_back({parts.back().end, parts.back().end});
            iterations = 0;
        }
        iterations += more;
        ++parts.back().end;
    }
    return parts;
}

// Returns the smallest number of bits, at least `bits`, that holds all ranks.
std::uint32_t bits_for(std::span<const FeatureThresholds> columns, std::uint32_t bits) {
    std::size_t most = 0;
    for (const FeatureThresholds& column : columns) most = std::max(most, column.thresholds.size());
    while (bits < k_float_bits && most >> bits != 0) bits *= 2;
    return bits;
}

// Returns a threshold in the kernel's form: see GroupedStump.
std::uint32_t device_threshold(float threshold, const FeatureThresholds& column, std::uint32_t bits) {
    if (bits == k_float_bits) return std::bit_cast<std::uint32_t>(threshold);
    return (((column.index_of(threshold) + 1) << (k_float_bits - bits)) ^ k_sign_bit) - 1;
}

// `columns` have the thresholds of all stumps, or more.
DeviceStumps group(const BoostedStumps& classifier, std::vector<FeatureThresholds> columns, std::uint32_t bits) {
    const GroupedStumps grouped(classifier);
    DeviceStumps result{.columns = std::move(columns),
                        .bits = bits,
                        .stumps = {},
                        .groups = {},
                        .parts = {},
                        .constant = classifier.constant()};
    for (const GroupedStumps::Group& group : grouped.groups)
        add_group({group.first, group.end, static_cast<std::uint32_t>(group.classes),
                   static_cast<std::uint32_t>(group.classes >> 32)},
                  result.groups);
    result.parts = parts_of(result.groups);
    for (const Stump& stump : grouped.stumps) {
        const auto column = std::ranges::lower_bound(result.columns, stump.feature, {}, &FeatureThresholds::feature);
        result.stumps.push_back({static_cast<std::uint32_t>(column - result.columns.begin()),
                                 device_threshold(stump.threshold, *column, result.bits), stump.above, stump.below});
    }
    return result;
}

// Copies values, without NaN and infinity (D15 in docs/portability.md). NaN and -infinity become the lowest float,
// which is above no threshold, and infinity the largest, which is above all.
void copy_finite(std::span<const float> values, std::span<std::byte> memory) {
    constexpr float k_largest = std::numeric_limits<float>::max();
    auto* out = reinterpret_cast<float*>(memory.data());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float above = values[i] > -k_largest ? values[i] : -k_largest;
        out[i] = above < k_largest ? above : k_largest;
    }
}

// Writes the values of a column in the kernel's form.
void write_features(std::span<const float> values, const FeatureThresholds& column, std::uint32_t bits,
                    std::span<std::byte> memory) {
    if (bits == 8)
        write_ranks(values, column, memory);
    else if (bits == 16)
        rank(values, column.thresholds, std::span(reinterpret_cast<std::uint16_t*>(memory.data()), values.size()),
             static_cast<std::uint16_t>(k_sign_bit >> 16));
    else
        copy_finite(values, memory);
}

// The rows of one matrix in a tile.
struct Piece {
    const ScoredMatrix* matrix;
    std::size_t first;  // of the matrix
    std::size_t rows;
    std::size_t place;  // of the first row in the tile
};

// Returns rows [first, first + rows) of the concatenated matrices.
std::vector<Piece> pieces_of(std::span<const ScoredMatrix> matrices, std::size_t first, std::size_t rows) {
    std::vector<Piece> pieces;
    std::size_t begin = 0;
    for (const ScoredMatrix& matrix : matrices) {
        const std::size_t end = begin + matrix.features->rows;
        const std::size_t from = std::max(begin, first), to = std::min(end, first + rows);
        if (from < to) pieces.push_back({&matrix, from - begin, to - from, from - first});
        begin = end;
    }
    return pieces;
}

// Where the parts of a tile's input are in its buffer, in bytes.
struct InputLayout {
    struct Part {
        std::size_t offset, bytes;
    };
    Part stumps, groups, constant, features;
    std::size_t bytes() const { return features.offset + features.bytes; }
};

InputLayout layout_of_input(const DeviceStumps& grouped, std::size_t feature_bytes, const DeviceInfo& info) {
    const std::size_t alignment = std::max<std::size_t>({info.storage_alignment, info.texel_alignment, 16});
    std::size_t end = 0;
    const auto part = [&](std::size_t bytes) {
        const std::size_t offset = (end + alignment - 1) / alignment * alignment;
        end = offset + bytes;
        return InputLayout::Part{offset, bytes};
    };
    InputLayout layout{};
    layout.stumps = part(grouped.stumps.size() * sizeof(GroupedStump));
    layout.groups = part(grouped.groups.size() * sizeof(StumpGroup));
    layout.constant = part(grouped.constant.size() * sizeof(float));
    layout.features = part(feature_bytes);
    return layout;
}

// Returns the layout of a texel of features. On cards it has the ranks of no more than one invocation's items.
StructLayout feature_texel(std::uint32_t bits, bool on_card) {
    return on_card && bits != k_float_bits ? layout_of<std::uint32_t>() : layout_of<shared::uvec4>();
}

template <typename T>
void write_part(const std::vector<T>& values, InputLayout::Part part, std::span<std::byte> memory) {
    std::ranges::copy(std::as_bytes(std::span(values)), memory.subspan(part.offset).begin());
}

}  // namespace

void write_ranks(std::span<const float> values, const FeatureThresholds& column, std::span<std::byte> memory) {
    rank(values, column.thresholds, std::span(reinterpret_cast<std::uint8_t*>(memory.data()), values.size()),
         static_cast<std::uint8_t>(k_sign_bit >> 24));
}

GpuStumpScorer::GpuStumpScorer(Device& device, Profiler* profiler, std::size_t tile_bytes)
    : device_(device),
      quads_(device.choose(k_stump_quads)),
      from_storage_(device.choose(k_stump_storage)),
      bits_(device.choose(k_stump_bits)),
      tile_bytes_(buffer_limit(device.info(), tile_bytes)),
      stream_(device, profiler) {}

struct GpuStumpScorer::Classifier {
    const DeviceStumps& grouped;
    std::uint32_t class_count;
    Link link;
    float scale;
    std::size_t feature_bytes(std::size_t rows) const { return rows * grouped.bits / 8; }  // of one column
};

// Returns the quads per invocation. On a CPU an invocation reads whole texels; with ranks, a texel holds more items, so
// it reads half as many texels.
std::uint32_t GpuStumpScorer::quads_of(std::uint32_t bits) const {
    if (bits == k_float_bits || device_.runs_card_kernels()) return quads_;
    return std::min(std::max(quads_ / 2, 1u) * (k_float_bits / bits), k_stump_quad_counts.back());
}

// Returns the rows of the smallest tile, that of k_stump_neighbors invocations, which read neighboring texels.
std::size_t GpuStumpScorer::tile_unit(std::uint32_t bits) const {
    return std::size_t{4} * quads_of(bits) * shared::k_stump_neighbors;
}

// Returns the rows of a tile: a multiple of tile_unit() for which both features and probabilities stay below the
// limits.
std::size_t GpuStumpScorer::rows_per_tile(const Classifier& classifier, std::size_t rows) const {
    const std::size_t unit = tile_unit(classifier.grouped.bits);
    const std::size_t columns = std::max<std::size_t>(classifier.grouped.columns.size(), 1);
    const std::size_t bytes =
        std::min<std::size_t>(tile_bytes_, feature_texel(classifier.grouped.bits, device_.runs_card_kernels()).bytes *
                                               device_.info().max_texels);
    const std::size_t most = std::min(8 * bytes / (columns * classifier.grouped.bits),
                                      tile_bytes_ / (classifier.class_count * sizeof(float)));
    return std::min(std::max(most / unit * unit, unit), (rows + unit - 1) / unit * unit);
}

const Kernel& GpuStumpScorer::kernel(std::uint32_t classes, std::uint32_t bits, bool in_parts) {
    Kernel& kernel = kernels_[{classes, bits, in_parts}];
    if (!kernel) {
        const bool on_card = device_.runs_card_kernels();
        kernel = Kernel(
            device_, shaders::learn_stumps_comp,
            {.push_constants = layout_of<StumpParameters>(),
             .elements = {feature_texel(bits, on_card), layout_of<shared::uvec4>(), layout_of<shared::uvec4>(),
                          layout_of<float>(), layout_of<float>(),
                          on_card ? layout_of<std::uint32_t>() : layout_of<shared::uvec4>()},
             .constants = {{0, classes}, {1, quads_of(bits)}, {2, from_storage_}, {3, bits}, {4, in_parts ? 1U : 0U}}});
    }
    return kernel;
}

void GpuStumpScorer::probabilities_of_all(const BoostedStumps& classifier, Link link, float scale,
                                          std::span<const ScoredMatrix> matrices) {
    for (const ScoredMatrix& matrix : matrices) check_scoring(classifier, *matrix.features, scale, matrix.out);
    const std::size_t rows =
        std::accumulate(matrices.begin(), matrices.end(), std::size_t{0},
                        [](std::size_t sum, const ScoredMatrix& matrix) { return sum + matrix.features->rows; });
    if (rows == 0) return;
    std::vector<FeatureThresholds> columns = thresholds_of(classifier.stumps);
    const std::uint32_t bits = bits_for(columns, bits_);
    const DeviceStumps grouped = group(classifier, std::move(columns), bits);
    const Classifier on_device{grouped, classifier.class_count, link, scale};
    const std::size_t tile_rows = rows_per_tile(on_device, rows);
    reserve(device_, probabilities_, tile_rows * classifier.class_count * sizeof(float));
    try {
        for (std::size_t first = 0; first < rows; first += tile_rows)
            score_tile(on_device, matrices, first, std::min(tile_rows, rows - first), tile_rows);
    } catch (...) {
        stream_.discard();
        throw;
    }
}

void GpuStumpScorer::score_tile(const Classifier& classifier, std::span<const ScoredMatrix> matrices, std::size_t first,
                                std::size_t rows, std::size_t stride) {
    const DeviceStumps& grouped = classifier.grouped;
    const std::size_t classes = classifier.class_count, column_bytes = classifier.feature_bytes(stride);
    const std::vector<Piece> pieces = pieces_of(matrices, first, rows);
    const InputLayout layout = layout_of_input(grouped, grouped.columns.size() * column_bytes, device_.info());
    reserve(device_, input_, layout.bytes());
    stream_.upload_with(input_, layout.bytes(), 0, [&](std::span<std::byte> memory) {
        write_part(grouped.stumps, layout.stumps, memory);
        write_part(grouped.groups, layout.groups, memory);
        write_part(grouped.constant, layout.constant, memory);
        parallel_for(grouped.columns.size(), [&](std::size_t c) {
            const FeatureThresholds& column = grouped.columns[c];
            const std::span<std::byte> rows_of_column = memory.subspan(layout.features.offset + c * column_bytes);
            for (const Piece& piece : pieces)
                write_features(piece.matrix->features->column(column.feature).subspan(piece.first, piece.rows), column,
                               grouped.bits, rows_of_column.subspan(classifier.feature_bytes(piece.place)));
        });
    });
    const auto range = [&](InputLayout::Part part) { return BufferRange(input_, part.offset, part.bytes); };
    dispatch(stream_, classifier, rows, column_bytes,
             {range(layout.features), range(layout.stumps), range(layout.groups), range(layout.constant),
              BufferRange(probabilities_, 0, stride * classes * sizeof(float))});
    std::vector<HostReadback> parts;
    parts.reserve(pieces.size());
    for (const Piece& piece : pieces)
        parts.push_back({piece.place * classes * sizeof(float), std::as_writable_bytes(piece.matrix->out.subspan(
                                                                    piece.first * classes, piece.rows * classes))});
    stream_.fetch(probabilities_, parts);
}

// Records the dispatches over rows of columns that are `column_bytes` apart.
void GpuStumpScorer::dispatch(Stream& stream, const Classifier& classifier, std::size_t rows, std::size_t column_bytes,
                              const Bindings& bindings) {
    const DeviceStumps& grouped = classifier.grouped;
    const std::size_t unit = tile_unit(grouped.bits);
    const std::size_t threads = (rows + unit - 1) / unit * shared::k_stump_neighbors;
    for (const GroupRange& part : grouped.parts) {
        const StumpParameters parameters{.rows = static_cast<std::uint32_t>(rows),
                                         .stride = static_cast<std::uint32_t>(column_bytes / sizeof(shared::uvec4)),
                                         .threads = static_cast<std::uint32_t>(threads),
                                         .first_group = part.first,
                                         .end_group = part.end,
                                         .groups = static_cast<std::uint32_t>(grouped.groups.size()),
                                         .link = static_cast<std::uint32_t>(classifier.link),
                                         .scale = classifier.scale};
        stream.dispatch(kernel(classifier.class_count, grouped.bits, grouped.parts.size() > 1), threads,
                        {bindings.features, bindings.stumps, bindings.groups, bindings.constant, bindings.probabilities,
                         bindings.features},
                        parameters);
    }
}

void GpuStumpScorer::record(Stream& stream, const BoostedStumps& classifier, Link link, float scale,
                            const Buffer& features, std::size_t rows, std::size_t stride, const Buffer& probabilities) {
    DeviceStumps grouped = group(classifier, thresholds_of(classifier.stumps), k_float_bits);
    const std::size_t columns = grouped.columns.empty() ? 0 : grouped.columns.back().feature + std::size_t{1};
    for (GroupedStump& stump : grouped.stumps) stump.column = grouped.columns[stump.column].feature;
    record_columns(stream, {grouped, classifier.class_count, link, scale}, columns, features, rows, stride,
                   probabilities);
}

void GpuStumpScorer::record_ranks(Stream& stream, const BoostedStumps& classifier, Link link, float scale,
                                  std::span<const FeatureThresholds> columns, const Buffer& ranks, std::size_t rows,
                                  std::size_t stride, const Buffer& probabilities) {
    for (const FeatureThresholds& needed : thresholds_of(classifier.stumps)) {
        const auto column = std::ranges::lower_bound(columns, needed.feature, {}, &FeatureThresholds::feature);
        if (column == columns.end() || column->feature != needed.feature ||
            column->thresholds.size() > k_max_ranked_thresholds ||
            !std::ranges::includes(column->thresholds, needed.thresholds))
            throw UsageError(fmt::format("no column of ranks answers all stumps of feature {}", needed.feature));
    }
    const DeviceStumps grouped = group(classifier, {columns.begin(), columns.end()}, k_rank_bits);
    record_columns(stream, {grouped, classifier.class_count, link, scale}, columns.size(), ranks, rows, stride,
                   probabilities);
}

void GpuStumpScorer::record_columns(Stream& stream, const Classifier& classifier, std::size_t columns,
                                    const Buffer& features, std::size_t rows, std::size_t stride,
                                    const Buffer& probabilities) {
    const DeviceStumps& grouped = classifier.grouped;
    const std::size_t column_bytes = classifier.feature_bytes(stride), feature_bytes = columns * column_bytes,
                      probability_bytes = stride * classifier.class_count * sizeof(float);
    if (stride % k_stump_stride != 0 || stride < rows || features.bytes() < feature_bytes ||
        probabilities.bytes() < probability_bytes)
        throw UsageError(fmt::format(
            "{} rows of {} columns, {} rows apart, and {} classes do not fit buffers of {} and {} bytes; the distance "
            "must be a multiple of {}",
            rows, columns, stride, classifier.class_count, features.bytes(), probabilities.bytes(), k_stump_stride));
    if (rows == 0) return;
    const Buffer stumps = uploaded<GroupedStump>(device_, stream, grouped.stumps),
                 groups = uploaded<StumpGroup>(device_, stream, grouped.groups),
                 constant = uploaded<float>(device_, stream, grouped.constant);
    dispatch(stream, classifier, rows, column_bytes,
             {BufferRange(features, 0, feature_bytes), stumps, groups, constant,
              BufferRange(probabilities, 0, probability_bytes)});
}

std::unique_ptr<StumpScorer> stump_scorer_for(Device& device) {
    if (device.host_is_faster()) return std::make_unique<CpuStumpScorer>();
    return std::make_unique<GpuStumpScorer>(device);
}

}  // namespace exemplar
