#pragma once

#include <atomic>
#include <functional>

namespace exemplar {

/// Runs `work` on this thread, and its parallel loops on all cores, so that it can be canceled: once `canceled` is
/// true, check_interrupt() throws Interrupted in this work and nowhere else. Rethrows what `work` throws.
void run_cancelable(const std::atomic<bool>& canceled, const std::function<void()>& work);

/// Returns whether this thread runs work that was canceled.
bool work_canceled();

}  // namespace exemplar
