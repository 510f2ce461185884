#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

namespace exemplar::python {

/// Runs long work without holding Python's lock, so that other Python threads continue. Checks for signals
/// meanwhile: Ctrl-C ends the work early and raises KeyboardInterrupt. Rethrows what the work throws. Must be called
/// with the lock held; the work must not touch Python objects.
void run_long(const std::function<void()>& work);

/// The same for work with a result.
template <typename Work>
auto long_result(Work&& work) {
    std::optional<std::invoke_result_t<Work>> result;
    run_long([&] { result.emplace(work()); });
    return std::move(*result);
}

}  // namespace exemplar::python
