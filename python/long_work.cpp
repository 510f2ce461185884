#include "python/long_work.h"

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <future>

#include "host/core/cancel.h"
#include "host/core/errors.h"

namespace exemplar::python {
namespace {

namespace py = pybind11;

constexpr std::chrono::milliseconds k_between_looks{50};

/// Waits for work on another thread. If a signal handler of Python raises an exception, cancels the work and returns
/// the exception. Python runs handlers only on its main thread; on other threads nothing cancels.
std::optional<py::error_already_set> wait_for(const std::future<void>& done, std::atomic<bool>& canceled) {
    std::optional<py::error_already_set> raised;
    const py::gil_scoped_release release;
    while (done.wait_for(k_between_looks) != std::future_status::ready) {
        if (canceled) continue;
        const py::gil_scoped_acquire acquire;
        if (PyErr_CheckSignals() == 0) continue;
        raised.emplace();
        canceled = true;
    }
    return raised;
}

}  // namespace

void run_long(const std::function<void()>& work) {
    std::atomic<bool> canceled = false;
    std::future<void> done = std::async(std::launch::async, [&] { run_cancelable(canceled, work); });
    std::optional<py::error_already_set> raised = wait_for(done, canceled);
    try {
        done.get();
    } catch (const Interrupted&) {
        if (!raised) throw;
    }
    if (raised) throw std::move(*raised);
}

}  // namespace exemplar::python
