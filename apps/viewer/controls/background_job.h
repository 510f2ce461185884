#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <utility>

namespace exemplar {

/// Work in the background that ends with a result and can be canceled. Classes that derive from it start it at the end
/// of their constructor and end it at the beginning of their destructor, as it uses their members.
template <typename Result>
class BackgroundJob {
  public:
    BackgroundJob(const BackgroundJob&) = delete;
    BackgroundJob& operator=(const BackgroundJob&) = delete;

    void cancel() { canceled_ = true; }
    bool canceled() const { return canceled_; }
    bool finished() const { return result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
    /// Since it was started.
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    /// What the work returned, once, when it is finished; throws what it threw, Interrupted if it was canceled.
    Result take() { return result_.get(); }

  protected:
    BackgroundJob() = default;
    ~BackgroundJob() = default;

    template <typename Work>
    void start(Work&& work) {
        result_ = std::async(std::launch::async, std::forward<Work>(work));
    }
    /// Cancels it and waits, which takes moments.
    void end() {
        cancel();
        if (result_.valid()) result_.wait();
    }
    /// What the work is to look at.
    const std::atomic<bool>& canceled_flag() const { return canceled_; }

  private:
    std::atomic<bool> canceled_ = false;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::future<Result> result_;
};

}  // namespace exemplar
