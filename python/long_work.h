#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

namespace exemplar::python {

/// Does work that may take long without holding Python's lock, so that other threads of Python go on, and looks for
/// signals meanwhile: after Ctrl-C the work ends early and KeyboardInterrupt is raised. Rethrows what the work throws.
/// To be called with the lock held; the work may not touch Python objects.
void run_long(const std::function<void()>& work);

/// The same of work that has a result.
template <typename Work>
auto long_result(Work&& work) {
    std::optional<std::invoke_result_t<Work>> result;
    run_long([&] { result.emplace(work()); });
    return std::move(*result);
}

}  // namespace exemplar::python
