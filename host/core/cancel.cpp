#include "host/core/cancel.h"

#include <sys/resource.h>
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#include <unistd.h>

#include <array>
#include <memory>
#include <mutex>
#include <vector>

namespace exemplar {
namespace {

// The cancellation flag of an arena's work; null while the arena is idle.
using Canceled = std::atomic<const std::atomic<bool>*>;
// The flag of the arena that this thread works for; null outside of arenas.
thread_local const Canceled* canceled_here = nullptr;

/// Sets canceled_here in threads that join the loops of an arena, and clears it when they leave.
class ArenaThreads : public tbb::task_scheduler_observer {
  public:
    ArenaThreads(tbb::task_arena& arena, const Canceled& canceled)
        : tbb::task_scheduler_observer(arena), canceled_(canceled) {
        observe(true);
    }
    ~ArenaThreads() override { observe(false); }
    ArenaThreads(const ArenaThreads&) = delete;
    ArenaThreads& operator=(const ArenaThreads&) = delete;

    void on_scheduler_entry(bool) override { canceled_here = &canceled_; }
    void on_scheduler_exit(bool) override { canceled_here = nullptr; }

  private:
    const Canceled& canceled_;
};

struct CancelableArena {
    explicit CancelableArena(LoopThreads loops)
        : arena(loops == LoopThreads::this_thread ? 1 : tbb::task_arena::automatic), threads(arena, canceled) {}
    Canceled canceled = nullptr;
    tbb::task_arena arena;
    ArenaThreads threads;
};

/// Arenas without work. They are never destroyed: TBB releases an observer only when the last thread that saw it
/// leaves, which may still happen at program exit.
struct IdleArenas {
    std::mutex mutex;
    std::vector<std::unique_ptr<CancelableArena>> arenas;
};
IdleArenas& idle_arenas(LoopThreads loops) {
    static auto* const idle = new std::array<IdleArenas, 2>;
    return (*idle)[loops == LoopThreads::this_thread ? 1 : 0];
}

/// Borrows an idle arena for the lifetime of this object.
class BorrowedArena {
  public:
    BorrowedArena(const std::atomic<bool>& canceled, LoopThreads loops) : idle_(idle_arenas(loops)) {
        const std::lock_guard lock(idle_.mutex);
        if (idle_.arenas.empty()) idle_.arenas.push_back(std::make_unique<CancelableArena>(loops));
        arena_ = std::move(idle_.arenas.back());
        idle_.arenas.pop_back();
        arena_->canceled = &canceled;
    }
    ~BorrowedArena() {
        arena_->canceled = nullptr;
        const std::lock_guard lock(idle_.mutex);
        idle_.arenas.push_back(std::move(arena_));
    }
    BorrowedArena(const BorrowedArena&) = delete;
    BorrowedArena& operator=(const BorrowedArena&) = delete;

    void execute(const std::function<void()>& work) { arena_->arena.execute(work); }

  private:
    IdleArenas& idle_;
    std::unique_ptr<CancelableArena> arena_;
};

}  // namespace

void run_cancelable(const std::atomic<bool>& canceled, const std::function<void()>& work, LoopThreads threads) {
    BorrowedArena(canceled, threads).execute(work);
}

void lower_thread_priority() {
    constexpr int k_niceness = 10;
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), k_niceness);
}

bool work_canceled() {
    const std::atomic<bool>* const canceled = canceled_here ? canceled_here->load() : nullptr;
    return canceled && *canceled;
}

}  // namespace exemplar
