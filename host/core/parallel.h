#pragma once

#include <cstddef>
#include <memory>

namespace exemplar {

/// Calls run(body, begin, end) for consecutive ranges that cover [0, count), as parallel_ranges does. It is a function,
/// not a template, so that TBB's loop is compiled once and not for every body.
void run_parallel_ranges(std::size_t count, std::size_t grain, const void* body,
                         void (*run)(const void* body, std::size_t begin, std::size_t end));

/// Calls body(begin, end) for consecutive ranges that cover [0, count); for loops that keep a workspace per range.
/// Throws Interrupted between two ranges once the user pressed Ctrl-C (see interrupt.h).
template <typename Body>
void parallel_ranges(std::size_t count, std::size_t grain, const Body& body) {
    run_parallel_ranges(count, grain, &body, [](const void* any, std::size_t begin, std::size_t end) {
        (*static_cast<const Body*>(any))(begin, end);
    });
}

/// Calls body(i) for i in [0, count) on all cores; at least half of `grain` neighboring indices run on one thread.
/// Each index runs exactly once and writes only what belongs to it, so results do not depend on the thread count.
/// Throws Interrupted as parallel_ranges does.
template <typename Body>
void parallel_for(std::size_t count, const Body& body, std::size_t grain = 1) {
    parallel_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i != end; ++i) body(i);
    });
}

/// Limits the number of threads of parallel loops during its lifetime; 0 means all cores.
class ThreadLimit {
  public:
    explicit ThreadLimit(std::size_t threads);
    ~ThreadLimit();

  private:
    class Control;
    std::unique_ptr<Control> control_;
};

}  // namespace exemplar
