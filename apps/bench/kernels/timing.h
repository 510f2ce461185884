#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "apps/bench/kernels/operation.h"

namespace exemplar {

/// Device milliseconds of each kernel in one run of an operation: a value per repeat, the mean of some runs.
using KernelTimes = std::map<std::string, std::vector<double>>;

/// What was measured of an operation, a value per repeat.
struct OperationTimes {
    KernelTimes kernels;
    std::vector<double> runs;  ///< milliseconds that the host needed and waited for in one run
};

struct TimingOptions {
    std::size_t repeats = 7;
    double seconds = 0.02;  ///< device time of a repeat, at least
};

/// Something to be timed; `profiler` sees its kernels.
struct Timed {
    std::string name;  ///< unlike all others'
    const Operation* operation;
    Profiler* profiler;
};

/// Times operations by the device's own timestamps, and whole runs by the host's clock, with Google Benchmark: repeats
/// of all of them in random turns, so that what slows the machine for a while slows all alike. Each has run before, as
/// drivers may compile at the first dispatch. Throws DeviceError if the device has no timestamps, Interrupted at
/// Ctrl-C.
std::vector<OperationTimes> time_in_turns(std::span<const Timed> timed, const TimingOptions& options);

}  // namespace exemplar
