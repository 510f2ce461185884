#pragma once

#include <atomic>
#include <functional>

namespace exemplar {

/// Does `work` on this thread, and its parallel loops on all cores, in a way that can be given up: once `canceled` is
/// true, check_interrupt() throws Interrupted there, and nowhere else. Rethrows what `work` throws.
void run_cancelable(const std::atomic<bool>& canceled, const std::function<void()>& work);

/// Whether this thread is at work that was canceled.
bool work_canceled();

}  // namespace exemplar
