#include "host/core/cancel.h"

#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

namespace exemplar {
namespace {

// What may cancel the work of this thread.
thread_local const std::atomic<bool>* canceled_here = nullptr;

/// Threads that join the loops of an arena are told what cancels it, and forget it when they leave.
class ArenaThreads : public tbb::task_scheduler_observer {
  public:
    ArenaThreads(tbb::task_arena& arena, const std::atomic<bool>& canceled)
        : tbb::task_scheduler_observer(arena), canceled_(canceled) {
        observe(true);
    }
    ~ArenaThreads() override { observe(false); }
    ArenaThreads(const ArenaThreads&) = delete;
    ArenaThreads& operator=(const ArenaThreads&) = delete;

    void on_scheduler_entry(bool) override { canceled_here = &canceled_; }
    void on_scheduler_exit(bool) override { canceled_here = nullptr; }

  private:
    const std::atomic<bool>& canceled_;
};

}  // namespace

void run_cancelable(const std::atomic<bool>& canceled, const std::function<void()>& work) {
    tbb::task_arena arena;
    const ArenaThreads threads(arena, canceled);
    arena.execute(work);
}

bool work_canceled() {
    return canceled_here && *canceled_here;
}

}  // namespace exemplar
