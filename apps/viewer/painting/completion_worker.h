#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/labeling/inference/model.h"
#include "host/labeling/painting/mesh_completion.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Completes painted labels in the background, so that painting never waits. Of several requests only the newest is
/// answered. Until the features of the mesh are computed, on a thread of their own, nearness alone counts; then the
/// last request is answered anew.
class CompletionWorker {
  public:
    CompletionWorker(TriangleMesh mesh, std::filesystem::path cache);
    ~CompletionWorker();
    CompletionWorker(const CompletionWorker&) = delete;
    CompletionWorker& operator=(const CompletionWorker&) = delete;

    /// Asks for a completion; `version` comes back with the answer.
    void request(std::vector<std::int32_t> painted, std::size_t labels, std::uint64_t version);
    /// Lets a model suggest labels, as soon as the features are computed. `palette`: the names of the labels.
    void suggest_by(std::shared_ptr<const LabelingModel> model, std::vector<std::string> palette);
    /// Completes without the model's labels from now on.
    void discard_suggestion();
    /// Returns the model's labels, once. Completions from then on correct these.
    std::optional<CompletedLabels> take_suggestion();

    struct Answer {
        CompletedLabels labels;
        std::uint64_t version = 0;
        double seconds = 0;  ///< that it took, from the request
    };
    /// Returns the newest answer, once.
    std::optional<Answer> take();
    /// Whether an answer is awaited.
    bool busy() const;
    bool has_features() const;
    /// Returns why features or completion failed, once; empty if nothing did.
    std::string take_error();

  private:
    struct Request {
        std::vector<std::int32_t> painted;
        std::size_t labels = 0;
        std::uint64_t version = 0;
        std::chrono::steady_clock::time_point asked{};
    };
    void run();
    void compute_features();
    void answer(const Request& request);
    void suggest(const LabelingModel& model, const std::vector<std::string>& palette);
    bool has_work() const { return next_ || repeats_ || discards_ || (model_ && features_); }

    TriangleMesh mesh_;
    std::filesystem::path cache_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::atomic<bool> ends_ = false;
    bool working_ = true, repeats_ = false, has_features_ = false, discards_ = false;
    std::optional<Request> next_;
    Request last_;
    std::shared_ptr<const LabelingModel> model_;  ///< that has not yet made a suggestion
    std::vector<std::string> palette_;
    std::unique_ptr<MeshFeatures> features_;
    std::optional<FaceDescriptors> descriptors_;
    std::optional<Answer> answer_;
    std::optional<CompletedLabels> suggestion_;
    std::string error_;
    std::unique_ptr<MeshCompletion> completion_;  ///< made by the thread
    std::thread feature_thread_, thread_;         ///< in this order, as the second starts the first
};

}  // namespace exemplar
