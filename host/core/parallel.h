#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <cstddef>

#include "host/core/interrupt.h"

namespace exemplar {

/// Calls body(begin, end) for consecutive ranges that cover [0, count); for loops that keep a workspace per range.
/// Throws Interrupted between two ranges once the user pressed Ctrl-C (see interrupt.h).
template <typename Body>
void parallel_ranges(std::size_t count, std::size_t grain, Body&& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          check_interrupt();
                          body(range.begin(), range.end());
                      });
}

/// Calls body(i) for i in [0, count) on all cores; at least half of `grain` neighboring indices run on one thread.
/// Each index runs exactly once and writes only what belongs to it, so results do not depend on the thread count.
/// Throws Interrupted as parallel_ranges does.
template <typename Body>
void parallel_for(std::size_t count, Body&& body, std::size_t grain = 1) {
    parallel_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i != end; ++i) body(i);
    });
}

/// Limits the number of threads of parallel loops during its lifetime; 0 means all cores.
class ThreadLimit {
  public:
    explicit ThreadLimit(std::size_t threads)
        : control_(
              tbb::global_control::max_allowed_parallelism,
              threads ? threads : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)) {}

  private:
    tbb::global_control control_;
};

}  // namespace exemplar
