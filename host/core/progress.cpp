#include "host/core/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <memory>
#include <utility>

#include "host/core/text.h"

namespace exemplar {
namespace {

std::atomic<bool> quiet_output{false};

using Listener = std::function<void(const ProgressState&)>;
std::mutex listener_mutex;
std::shared_ptr<const Listener> current_listener;

std::shared_ptr<const Listener> listener() {
    const std::lock_guard lock(listener_mutex);
    return current_listener;
}

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

Progress::Progress(std::string what, std::size_t total)
    : what_(std::move(what)),
      total_(total),
      start_(Clock::now()),
      printed_(Clock::now()),
      finished_(false),
      on_terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
    if (!finished_ && done_ < total_) {  // abandoned by an error: keep the line without claiming completion
        if (on_terminal_ && !quiet_output) fmt::print(stderr, "\n");
        finished_ = true;
    }
    finish();
}

void Progress::set_listener(Listener listener) {
    const std::lock_guard lock(listener_mutex);
    current_listener = listener ? std::make_shared<const Listener>(std::move(listener)) : nullptr;
}

void Progress::set_quiet(bool quiet) {
    quiet_output = quiet;
}

void Progress::advance(std::size_t steps, const std::string& detail) {
    const std::lock_guard lock(mutex_);
    if (finished_) return;
    done_ += steps;
    detail_ = without_controls(detail);
    if (const auto hears = listener()) {
        (*hears)({what_, done_, total_});
        return;
    }
    const double interval = on_terminal_ ? 0.1 : 5.0;
    if (seconds_since(printed_) >= interval) print(false);
}

void Progress::finish() {
    const std::lock_guard lock(mutex_);
    if (finished_) return;
    print(true);
    finished_ = true;
}

void Progress::print(bool last) {
    printed_ = Clock::now();
    if (quiet_output || listener()) return;
    const double elapsed = seconds_since(start_);
    // Some tasks end early because nothing is left to improve, so the last line shows the steps done, not the total.
    std::string line = last ? fmt::format("{}: {} in {}", what_, done_, format_seconds(elapsed))
                            : fmt::format("{}: {}/{}", what_, done_, total_);
    if (!last && done_ > total_ / 100) {  // the first steps may include preparations, and are a poor estimate
        const double left =
            elapsed * static_cast<double>(total_ - std::min(done_, total_)) / static_cast<double>(done_);
        line += ", " + format_seconds(left) + " left";
        if (!detail_.empty()) line += " (" + detail_ + ")";
    }
    if (on_terminal_)
        fmt::print(stderr, "\r\033[K{}{}", line, last ? "\n" : "");
    else
        fmt::print(stderr, "{}\n", line);
    std::fflush(stderr);
}

}  // namespace exemplar
