#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/device/tuning.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/learn/boosting/threshold_ranks.h"

namespace exemplar {

/// Quads (four items) per invocation. On a CPU each loaded stump is used for many items (D6 in docs/portability.md),
/// and for at least those of a texel, which holds more of them with features of fewer bits.
inline constexpr std::array<std::uint32_t, 4> k_stump_quad_counts{1, 2, 4, 8};
inline constexpr TunableParameter k_stump_quads{"learn/stumps.comp", "quads", k_stump_quad_counts, 4, 1};
/// How features are read: as texels (0) or from a storage buffer (1).
inline constexpr std::array<std::uint32_t, 2> k_stump_readings{0, 1};
inline constexpr TunableParameter k_stump_storage{"learn/stumps.comp", "storage", k_stump_readings, 0, 0};
/// Bits of a feature: 32 for a float, 16 or 8 for its rank among the classifier's thresholds, which the host
/// computes during the upload. Probabilities are the same, bit for bit. A byte is a quarter of a float's upload.
inline constexpr std::array<std::uint32_t, 3> k_stump_feature_bits{8, 16, 32};
inline constexpr TunableParameter k_stump_bits{"learn/stumps.comp",     "bits", k_stump_feature_bits, 8, 8,
                                               TuningMetric::end_to_end};

/// Distances between columns of features on the device are multiples of this, in rows.
constexpr std::size_t k_stump_stride = 256;
/// Most thresholds of a column whose ranks are one byte each.
constexpr std::size_t k_max_ranked_thresholds = 255;
/// Writes the ranks of values among the thresholds of their column, at most k_max_ranked_thresholds, as
/// GpuStumpScorer::record_ranks reads them: one byte each, 128 + rank, modulo 256.
void write_ranks(std::span<const float> values, const FeatureThresholds& column, std::span<std::byte> memory);

/// Boosted stumps on the device. Only the features that stumps use are uploaded, as floats or as ranks
/// (k_stump_bits). The rows of all matrices that are scored together are concatenated and cut into tiles that fit
/// the device's limits, one submission and two copies each. Long classifiers take several dispatches
/// (k_max_iterations). Probabilities agree with CpuStumpScorer within 1e-5: the order of summation differs, and exp
/// differs between devices.
class GpuStumpScorer final : public StumpScorer {
  public:
    /// `tile_bytes` limits the size of a tile's features, and of its probabilities, below the device's own limits.
    explicit GpuStumpScorer(Device& device, Profiler* profiler = nullptr,
                            std::size_t tile_bytes = std::size_t{256} << 20);
    void probabilities_of_all(const BoostedStumps& classifier, Link link, float scale,
                              std::span<const ScoredMatrix> matrices) override;

    /// Records the scoring of features that are in a buffer already: columns by the numbers that the classifier's
    /// stumps have, `stride` floats each, a multiple of k_stump_stride (at least `rows`), all finite in the first
    /// `rows` of a column. Writes a probability per class and row, item-major, to `probabilities`, for `stride` rows.
    /// Probabilities are those of probabilities_of_all. Throws UsageError if a buffer is too small, and as
    /// Stream::dispatch.
    void record(Stream& stream, const BoostedStumps& classifier, Link link, float scale, const Buffer& features,
                std::size_t rows, std::size_t stride, const Buffer& probabilities);
    /// The same for ranks, of one byte each, as write_ranks writes them. Column i has the feature columns[i].feature
    /// and its ranks among columns[i].thresholds. Features rise from column to column; each that a stump uses is there,
    /// with all thresholds of its stumps and at most k_max_ranked_thresholds; else throws UsageError.
    void record_ranks(Stream& stream, const BoostedStumps& classifier, Link link, float scale,
                      std::span<const FeatureThresholds> columns, const Buffer& ranks, std::size_t rows,
                      std::size_t stride, const Buffer& probabilities);

  private:
    // A classifier on the device.
    struct Classifier;
    void score_tile(const Classifier& classifier, std::span<const ScoredMatrix> matrices, std::size_t first,
                    std::size_t rows, std::size_t stride);
    // What the kernel reads and writes.
    struct Bindings {
        BufferRange features, stumps, groups, constant, probabilities;
    };
    void record_columns(Stream& stream, const Classifier& classifier, std::size_t columns, const Buffer& features,
                        std::size_t rows, std::size_t stride, const Buffer& probabilities);
    void dispatch(Stream& stream, const Classifier& classifier, std::size_t rows, std::size_t column_bytes,
                  const Bindings& bindings);
    const Kernel& kernel(std::uint32_t classes, std::uint32_t bits, bool in_parts);
    std::uint32_t quads_of(std::uint32_t bits) const;
    std::size_t tile_unit(std::uint32_t bits) const;
    std::size_t rows_per_tile(const Classifier& classifier, std::size_t rows) const;
    Device& device_;
    std::uint32_t quads_;  // of items, per invocation
    std::uint32_t from_storage_;
    std::uint32_t bits_;  // minimum bits of a feature; more if a classifier has more thresholds than ranks of these
    std::size_t tile_bytes_;
    Stream stream_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, bool>, Kernel> kernels_;  // by class count, bits, parts
    // Kept between calls.
    Buffer input_, probabilities_;
};

/// Returns the fastest scorer of a device. If it is this machine's CPU, that is the host's (D6 in docs/portability.md).
std::unique_ptr<StumpScorer> stump_scorer_for(Device& device);

}  // namespace exemplar
