#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <utility>

namespace exemplar {

/// Background work with a result that can be canceled. Derived classes call start() at the end of their constructor
/// and end() at the beginning of their destructor, as the work uses their members.
template <typename Result>
class BackgroundJob {
  public:
    BackgroundJob(const BackgroundJob&) = delete;
    BackgroundJob& operator=(const BackgroundJob&) = delete;

    void cancel() { canceled_ = true; }
    bool canceled() const { return canceled_; }
    bool finished() const { return result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
    /// Seconds since the start.
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    /// Returns the result, once, when the work is finished. Throws what the work threw; Interrupted if it was
    /// canceled.
    Result take() { return result_.get(); }

  protected:
    BackgroundJob() = default;
    ~BackgroundJob() = default;

    template <typename Work>
    void start(Work&& work) {
        result_ = std::async(std::launch::async, std::forward<Work>(work));
    }
    /// Cancels the work and waits briefly for its end.
    void end() {
        cancel();
        if (result_.valid()) result_.wait();
    }
    /// The flag that the work must check.
    const std::atomic<bool>& canceled_flag() const { return canceled_; }

  private:
    std::atomic<bool> canceled_ = false;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::future<Result> result_;
};

}  // namespace exemplar
