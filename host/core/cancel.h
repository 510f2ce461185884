#pragma once

#include <atomic>
#include <functional>

namespace exemplar {

/// Threads that run the parallel loops of cancelable work.
enum class LoopThreads { all_cores, this_thread };

/// Runs `work` on this thread, and its parallel loops on all cores unless said otherwise, so that it can be canceled:
/// once `canceled` is true, check_interrupt() throws Interrupted in this work and nowhere else. Rethrows what `work`
/// throws.
void run_cancelable(const std::atomic<bool>& canceled, const std::function<void()>& work,
                    LoopThreads threads = LoopThreads::all_cores);

/// Lets other threads of the machine go first from now on. Does nothing where the system cannot.
void lower_thread_priority();

/// Returns whether this thread runs work that was canceled.
bool work_canceled();

}  // namespace exemplar
