#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"
#include "gpu/runtime/device/tuning.h"
#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// Items per invocation, by four; of features of fewer bits at least those of a texel.
inline constexpr std::array<std::uint32_t, 4> k_stump_quad_counts{1, 2, 4, 8};
inline constexpr TunableParameter k_stump_quads{"learn/stumps.comp", "quads", k_stump_quad_counts};
/// How features are read: as texels (0) or from a storage buffer (1).
inline constexpr std::array<std::uint32_t, 2> k_stump_readings{0, 1};
inline constexpr TunableParameter k_stump_storage{"learn/stumps.comp", "storage", k_stump_readings};
/// Bits of a feature: 32 of a float; 16 or 8 of its rank among the classifier's thresholds, which the host finds out
/// when it uploads. Probabilities are the same, bit for bit.
inline constexpr std::array<std::uint32_t, 3> k_stump_feature_bits{8, 16, 32};
inline constexpr TunableParameter k_stump_bits{"learn/stumps.comp", "bits", k_stump_feature_bits, Judged::by_runs};

/// Boosted stumps on the device. Only the features that stumps use are uploaded, as floats or as ranks (k_stump_bits).
/// The rows of all matrices that are scored together lie side by side, in tiles that fit the device's limits: a
/// submission each. Long classifiers take several dispatches (k_most_iterations). Probabilities agree with
/// CpuStumpScorer within 1e-5: sums are taken in another order, and exp differs between devices.
class GpuStumpScorer final : public StumpScorer {
  public:
    /// `tile_bytes` bounds the memory of a tile's features and of its probabilities below the device's own limits.
    explicit GpuStumpScorer(Device& device, Profiler* profiler = nullptr,
                            std::size_t tile_bytes = std::size_t{256} << 20);
    void probabilities_of_all(const BoostedStumps& classifier, Link link, float scale,
                              std::span<const ScoredMatrix> matrices) override;

  private:
    // A classifier on the device.
    struct Classifier;
    void score_tile(const Classifier& classifier, std::span<const ScoredMatrix> matrices, std::size_t first,
                    std::size_t rows, std::size_t stride);
    template <typename T>
    void upload(Buffer& buffer, const std::vector<T>& values);
    const Kernel& kernel(std::uint32_t classes, std::uint32_t bits, bool in_parts);
    std::uint32_t quads_of(std::uint32_t bits) const;
    std::size_t tile_unit(std::uint32_t bits) const;
    std::size_t rows_per_tile(const Classifier& classifier, std::size_t rows) const;
    Device& device_;
    std::uint32_t quads_;  // of items per invocation
    std::uint32_t from_storage_;
    std::uint32_t bits_;  // of a feature, where a classifier has no more thresholds than these can tell apart
    std::size_t tile_bytes_;
    Stream stream_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, bool>, Kernel> kernels_;  // by class count, bits, parts
    // Kept between calls.
    Buffer stumps_, groups_, constant_, features_, probabilities_;
};

}  // namespace exemplar
