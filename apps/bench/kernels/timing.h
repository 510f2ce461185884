#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "apps/bench/kernels/operation.h"

namespace exemplar {

/// Device milliseconds of each kernel in one run of an operation: a value per repeat, each the mean of several runs.
using KernelTimes = std::map<std::string, std::vector<double>>;

/// Times of an operation, a value per repeat.
struct OperationTimes {
    KernelTimes kernels;
    std::vector<double> runs;  ///< milliseconds of one run on the host, waiting included
};

struct TimingOptions {
    std::size_t repeats = 7;
    double seconds = 0.02;  ///< minimum device time of a repeat, less where wall_seconds bounds it
    /// Bound of the time that passes, the host's work included. Where even single runs take longer, there are fewer
    /// repeats, but no less than three.
    double wall_seconds = 60;
};

/// An operation to be timed; its kernels report to `profiler`.
struct Timed {
    std::string name;  ///< unique
    const Operation* operation;
    Profiler* profiler;
};

/// Times operations by timestamps of the device, and whole runs by the host's clock, with Google Benchmark. Repeats
/// of all operations take turns at random, so that a temporary slowdown of the machine affects all alike. Each
/// operation must have run before (D17 in docs/portability.md). Throws DeviceError if the device has no timestamps,
/// Interrupted at Ctrl-C.
std::vector<OperationTimes> time_in_turns(std::span<const Timed> timed, const TimingOptions& options);

}  // namespace exemplar
