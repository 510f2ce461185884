#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/exemplar/backend.h"
#include "apps/exemplar/label/evaluation_summary.h"
#include "apps/exemplar/label/training_run.h"
#include "apps/report/report_page.h"
#include "host/core/progress.h"
#include "host/data/corpus.h"

namespace exemplar {

/// Returns a hash of the content of a mesh file and of its label file, as 16 hexadecimal digits. Results that are kept
/// are not mixed with those of other meshes.
std::string digest_of_labeled(const std::filesystem::path& mesh, const std::filesystem::path& labels_folder = {});

/// One training and the tests of its model.
struct EvaluationTask {
    std::string category, split;  ///< name the output folder OUT/CATEGORY/SPLIT
    std::vector<std::filesystem::path> train, test;
    std::filesystem::path humans;           ///< human segmentations; may be empty
    std::filesystem::path labels = {};      ///< folder of the label files; empty: beside the meshes
    std::vector<std::string> sources = {};  ///< the set of each training mesh, if several are merged
    bool other_category = false;            ///< rates count only the labels of both training and test meshes
};

/// Runs tasks and keeps finished results on disk, so that an interrupted run can continue:
/// OUT/CATEGORY/SPLIT/model.safetensors and, per test mesh, NAME_labels.txt, NAME.ply and NAME.json (its scores).
/// Results are reused if options, training meshes and labels, and the test mesh are unchanged.
class EvaluationRun {
  public:
    struct Behavior {
        bool quiet = false;                        ///< no tables, no warnings
        bool fresh = false;                        ///< reuse nothing of an earlier run
        bool learning_curve = false;               ///< measure the rate against the number of training meshes
        double memory = k_feature_gigabytes;       ///< for the features of training meshes
        std::filesystem::path report = {};         ///< the page's folder; empty: the output folder
        std::vector<ReportDrawing> drawings = {};  ///< below the categories of the page
    };
    EvaluationRun(DeviceBackend& backend, const TrainOptions& train, std::filesystem::path cache,
                  std::filesystem::path out, Behavior behavior)
        : backend_(backend),
          train_(train),
          cache_(std::move(cache)),
          out_(std::move(out)),
          behavior_(std::move(behavior)) {}

    /// Runs all tasks and writes index.html; returns the report (docs/formats.md).
    nlohmann::json evaluate(const std::vector<EvaluationTask>& tasks, const std::string& protocol,
                            const std::string& title);

  private:
    LabelingModel model_for(const EvaluationTask& task, const std::filesystem::path& folder, const std::string& key);
    nlohmann::json finished(const std::filesystem::path& path, const std::string& key) const;
    void warn(const std::vector<std::string>& warnings) const;
    LabeledCorpus load_test_mesh(const EvaluationTask& task, const std::filesystem::path& mesh,
                                 const LabelingModel& model) const;
    nlohmann::json test_mesh(const EvaluationTask& task, const std::filesystem::path& mesh,
                             const std::filesystem::path& folder, const LabelingModel& model, const std::string& key);
    nlohmann::json run_task(const EvaluationTask& task, Progress& progress);
    ReportMesh report_mesh(const LabelingModel& model, LabeledCorpus& shown, const std::vector<std::string>& names);
    void write_page(const std::vector<EvaluationTask>& tasks, const nlohmann::json& report, const std::string& title);

    DeviceBackend& backend_;
    TrainOptions train_;
    std::filesystem::path cache_, out_;
    Behavior behavior_;
};

}  // namespace exemplar
