#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "gpu/labeling/context_kernels.h"
#include "gpu/learn/stump_scorer.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"
#include "host/labeling/inference/labeler.h"

namespace exemplar {

/// Maximum bytes of the cascade's largest buffer, unless the device's limits are lower.
constexpr std::size_t k_cascade_tile_bytes = std::size_t{256} << 20;

/// Rows per invocation. On a CPU each loaded weight is used for many rows: D6 in docs/portability.md.
inline constexpr std::array<std::uint32_t, 4> k_linear_row_counts{1, 2, 4, 8};
inline constexpr TunableParameter k_linear_rows{"labeling/context_linear.comp", "rows", k_linear_row_counts, 4, 2};

/// The classifiers of a model on the device. The first submission uploads the base features once, as ranks among the
/// thresholds of all stages, and runs the whole cascade of the faces and the first classifier of the edges; contextual
/// histograms and predictions stay on the device. Linear classifiers need the base features themselves: the host
/// computes that part of their scores and uploads it. Each further classifier of the edges is a submission, as the host
/// computes its few contextual columns. Probabilities agree with those of the same classifiers one by one
/// (GpuStumpScorer, GpuContextHistograms) except where a histogram, summed in another order, falls on the other side of
/// a threshold. In FaceScores::seconds, the first submission counts as "unary".
class GpuCascade final : public CascadeScorer {
  public:
    /// `scorer` must outlive this. `tile_bytes` limits the size of each buffer below the device's own limits.
    GpuCascade(Device& device, GpuStumpScorer& scorer, Profiler* profiler = nullptr,
               std::size_t tile_bytes = k_cascade_tile_bytes);
    std::size_t fitting(const LabelingModel& model, std::span<MeshFeatures* const> meshes) const override;
    /// Throws UsageError if the sizes of a mesh's context contradict each other, DeviceMemoryError if memory is used
    /// up; then fewer meshes may be scored.
    std::vector<FaceScores> score(const LabelingModel& model, std::span<MeshFeatures* const> meshes) override;

  private:
    // The columns that a cascade compares with thresholds, and the rows of several meshes: see cascade.cpp.
    struct Columns;
    struct Rows;
    std::vector<FaceScores> score_checked(const LabelingModel& model, std::span<MeshFeatures* const> meshes);
    void upload_ranks(const Columns& columns, const Rows& rows, std::span<MeshFeatures* const> meshes,
                      FeatureMatrix MeshFeatures::*matrix, Buffer& ranks);
    void upload_geometry(const Rows& rows, std::span<MeshFeatures* const> meshes, std::size_t classes);
    void upload_linear(const LabelingModel& model, std::size_t stage, const Rows& rows,
                       std::span<MeshFeatures* const> meshes);
    void record_unary(const LabelingModel& model, const Columns& columns, const Rows& rows,
                      std::span<MeshFeatures* const> meshes);
    void record_context_ranks(const Columns& columns, std::size_t stage, const Rows& rows, std::size_t classes);
    void record_linear(const LinearClassifier& classifier, std::size_t base, const Rows& rows,
                       const BufferRange& scores);
    void record_prediction(const LabelingModel& model, std::size_t stage, const Rows& rows);
    void record_boundary(const LabelingModel& model, const Columns& columns, std::size_t stage, const Rows& rows);
    void upload_edge_context(const Columns& columns, std::size_t stage, const Rows& rows,
                             std::span<MeshFeatures* const> meshes, std::span<const FaceScores> scores);
    const Kernel& prediction_kernel(std::uint32_t classes);
    Device& device_;
    GpuStumpScorer& scorer_;
    std::size_t tile_bytes_;
    Stream stream_;
    ContextKernels context_;
    std::uint32_t rows_per_thread_;
    Kernel linear_kernel_, rank_kernel_;
    std::map<std::uint32_t, Kernel> prediction_kernels_;  // by class count
    Buffer face_ranks_, edge_ranks_;                      // columns x rows, a byte each
    Buffer stumps_, prediction_, means_;                  // rows x classes: of a stage, of the cascade, over its stages
    Buffer linear_;                                       // stages x rows x classes
    Buffer boundary_;                                     // edges x 2
};

}  // namespace exemplar
