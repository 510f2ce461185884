#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/exemplar/backend.h"
#include "apps/exemplar/bench/bench_table.h"
#include "host/animation/animation.h"
#include "host/curvature/model/model.h"
#include "host/curvature/state/samples.h"
#include "host/data/corpus.h"
#include "host/labeling/features/features.h"
#include "host/labeling/inference/model.h"

namespace exemplar {

/// A generated character of 20,000 vertices with two different motions.
struct BenchCharacter {
    Animation seen, unseen;
    std::vector<FrameRef> seen_frames, unseen_frames;
};

/// Data that the rows of `exemplar bench` share, made at first use.
class BenchContext {
  public:
    struct Options {
        std::filesystem::path meshes;  ///< labeled meshes; empty: generated ones
        std::string device;
        bool quick = false;  ///< one run of each, and none on one thread
    };
    explicit BenchContext(Options options) : options_(std::move(options)) {}

    bool quick() const { return options_.quick; }
    std::size_t runs() const { return options_.quick ? 1 : 3; }
    const std::string& device_name() const { return options_.device; }
    DeviceBackend& backend();
    const LabeledCorpus& corpus();
    /// The mesh of the corpus whose size is nearest to 20,000 faces.
    const LabeledMesh& mesh();
    /// The model of the training row if that has run, else one trained on fewer faces.
    const LabelingModel& model();
    void set_model(LabelingModel model) { model_ = std::move(model); }
    const BenchCharacter& character();
    /// A model of the character: that of a training row if one has run, else one trained on fewer poses.
    const CurvatureModel& curvature_model();
    void set_curvature_model(CurvatureModel model) { curvature_model_ = std::move(model); }

  private:
    Options options_;
    std::unique_ptr<DeviceBackend> backend_;
    std::optional<LabeledCorpus> corpus_;
    std::optional<LabelingModel> model_;
    std::optional<BenchCharacter> character_;
    std::optional<CurvatureModel> curvature_model_;
};

/// A part of the table: the rows that --only NAME selects.
struct BenchPart {
    const char* name;
    bool only_full;  ///< takes many minutes: only with --full or --only
    /// Measures, and passes each row to `row` when it is done.
    void (*run)(BenchContext& context, const std::function<void(const BenchRow&)>& row);
};

// bench_labeling.cpp
void bench_features(BenchContext& context, const std::function<void(const BenchRow&)>& row);
void bench_training(BenchContext& context, const std::function<void(const BenchRow&)>& row);
void bench_labeling(BenchContext& context, const std::function<void(const BenchRow&)>& row);
// bench_learning.cpp
void bench_boosting(BenchContext& context, const std::function<void(const BenchRow&)>& row);
void bench_scoring(BenchContext& context, const std::function<void(const BenchRow&)>& row);
void bench_cut(BenchContext& context, const std::function<void(const BenchRow&)>& row);
// bench_curvature.cpp
void bench_curvature(BenchContext& context, const std::function<void(const BenchRow&)>& row);
// bench_lines.cpp
void bench_lines(BenchContext& context, const std::function<void(const BenchRow&)>& row);
// bench_host_work.cpp
void bench_host_work(BenchContext& context, const std::function<void(const BenchRow&)>& row);
// bench_scaling.cpp
void bench_scaling(BenchContext& context, const std::function<void(const BenchRow&)>& row);
void bench_arrangements(BenchContext& context, const std::function<void(const BenchRow&)>& row);

}  // namespace exemplar
