#include "host/core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "host/core/interrupt.h"

namespace exemplar {

void run_parallel_ranges(std::size_t count, std::size_t grain, const void* body,
                         void (*run)(const void* body, std::size_t begin, std::size_t end)) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [=](const tbb::blocked_range<std::size_t>& range) {
                          check_interrupt();
                          run(body, range.begin(), range.end());
                      });
}

class ThreadLimit::Control : public tbb::global_control {
  public:
    using global_control::global_control;
};

ThreadLimit::ThreadLimit(std::size_t threads)
    : control_(std::make_unique<Control>(
          tbb::global_control::max_allowed_parallelism,
          threads ? threads : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism))) {}

ThreadLimit::~ThreadLimit() = default;

}  // namespace exemplar
