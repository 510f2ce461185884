#include "apps/viewer/painting/completion_worker.h"

#include <exception>
#include <utility>

#include "host/core/cancel.h"
#include "host/core/errors.h"
#include "host/labeling/features/fast_context.h"
#include "host/labeling/painting/suggestions.h"

namespace exemplar {

using Clock = std::chrono::steady_clock;

CompletionWorker::CompletionWorker(TriangleMesh mesh, std::filesystem::path cache)
    : mesh_(std::move(mesh)), cache_(std::move(cache)), thread_([this] { run(); }) {}

CompletionWorker::~CompletionWorker() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    wake_.notify_all();
    thread_.join();
    if (feature_thread_.joinable()) feature_thread_.join();
}

void CompletionWorker::request(std::vector<std::int32_t> painted, std::size_t labels, std::uint64_t version) {
    const std::lock_guard lock(mutex_);
    next_ = Request{std::move(painted), labels, version, Clock::now()};
    wake_.notify_all();
}

void CompletionWorker::suggest_by(std::shared_ptr<const LabelingModel> model, std::vector<std::string> palette) {
    const std::lock_guard lock(mutex_);
    model_ = std::move(model);
    palette_ = std::move(palette);
    wake_.notify_all();
}

void CompletionWorker::discard_suggestion() {
    const std::lock_guard lock(mutex_);
    model_.reset();
    suggestion_.reset();
    discards_ = repeats_ = true;
    wake_.notify_all();
}

std::optional<CompletedLabels> CompletionWorker::take_suggestion() {
    const std::lock_guard lock(mutex_);
    return std::exchange(suggestion_, std::nullopt);
}

std::optional<CompletionWorker::Answer> CompletionWorker::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(answer_, std::nullopt);
}

bool CompletionWorker::busy() const {
    const std::lock_guard lock(mutex_);
    return working_ || has_work();
}

bool CompletionWorker::has_features() const {
    const std::lock_guard lock(mutex_);
    return has_features_;
}

std::string CompletionWorker::take_error() {
    const std::lock_guard lock(mutex_);
    return std::exchange(error_, {});
}

void CompletionWorker::compute_features() {
    try {
        run_cancelable(ends_, [this] {
            auto features = std::make_unique<MeshFeatures>(completion_->compute_features(cache_));
            FaceDescriptors descriptors = face_descriptors(*features);
            const std::lock_guard lock(mutex_);
            features_ = std::move(features);
            descriptors_ = std::move(descriptors);
            repeats_ = true;
        });
    } catch (const Interrupted&) {  // the shape was closed, or the program ends
        return;
    } catch (const std::exception& error) {
        const std::lock_guard lock(mutex_);
        error_ = error.what();
    }
    wake_.notify_all();
}

void CompletionWorker::suggest(const LabelingModel& model, const std::vector<std::string>& palette) {
    CpuStumpScorer scorer;
    FastContextHistograms context;
    MeshFeatures* const features = features_.get();
    Suggestion suggestion =
        std::move(suggest_labels(model, std::span(&features, 1), palette, {scorer, context}).front());
    completion_->set_evidence(std::move(suggestion.evidence));
    CompletedLabels labels = completion_->on_original(suggestion.labels);
    const std::lock_guard lock(mutex_);
    suggestion_ = std::move(labels);
    repeats_ = true;
}

void CompletionWorker::answer(const Request& request) {
    if (request.labels == 0) return;
    CompletedLabels labels = completion_->complete(request.painted, request.labels);
    const std::lock_guard lock(mutex_);
    answer_ =
        Answer{std::move(labels), request.version, std::chrono::duration<double>(Clock::now() - request.asked).count()};
}

void CompletionWorker::run() {
    try {
        completion_ = std::make_unique<MeshCompletion>(mesh_);
        feature_thread_ = std::thread([this] { compute_features(); });
        std::unique_lock lock(mutex_);
        while (true) {
            working_ = false;
            wake_.wait(lock, [this] { return ends_ || has_work(); });
            if (ends_) return;
            working_ = true;
            if (auto descriptors = std::exchange(descriptors_, std::nullopt)) {
                completion_->set_descriptors(std::move(*descriptors));
                has_features_ = true;
            }
            if (std::exchange(discards_, false)) {
                completion_->set_evidence({});
                suggestion_.reset();
            }
            const auto model = features_ ? std::exchange(model_, nullptr) : nullptr;
            const std::vector<std::string> palette = palette_;
            if (next_) last_ = std::move(*std::exchange(next_, std::nullopt));
            if (std::exchange(repeats_, false)) last_.asked = Clock::now();
            lock.unlock();
            model ? suggest(*model, palette) : answer(last_);
            lock.lock();
        }
    } catch (const std::exception& error) {
        const std::lock_guard lock(mutex_);
        error_ = error.what();
        working_ = false;
    }
}

}  // namespace exemplar
