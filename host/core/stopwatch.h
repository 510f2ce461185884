#pragma once

#include <chrono>
#include <ctime>

namespace exemplar {

/// Wall and CPU time since construction, in seconds. CPU time is of the whole process, all threads.
class Stopwatch {
  public:
    Stopwatch() : wall_(std::chrono::steady_clock::now()), cpu_(cpu_now()) {}
    double wall() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count(); }
    double cpu() const { return cpu_now() - cpu_; }

  private:
    static double cpu_now() {
        timespec t{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    }
    std::chrono::steady_clock::time_point wall_;
    double cpu_;
};

}  // namespace exemplar
