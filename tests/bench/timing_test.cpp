#include "apps/bench/kernels/timing.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "apps/bench/kernels/measurement.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/stopwatch.h"

namespace exemplar {
namespace {

// An operation that pretends to take so long on the device, and really does so on the host.
struct Pretended {
    Pretended(double device_milliseconds, int host_milliseconds) {
        operation.run = [this, device_milliseconds, host_milliseconds] {
            std::this_thread::sleep_for(std::chrono::milliseconds(host_milliseconds));
            profiler.add("kernel", device_milliseconds);
            ++runs;
        };
    }
    Profiler profiler;
    Operation operation;
    int runs = 0;
};

TEST(Timing, WallTimeBoundsWhatTheHostTakesLongFor) {
    Pretended slow(0.001, 5);
    const Stopwatch watch;
    const auto times = time_in_turns(std::vector<Timed>{{"slow", &slow.operation, &slow.profiler}},
                                     {.repeats = 7, .seconds = 1, .wall_seconds = 0.5});
    EXPECT_LT(watch.wall(), 3) << slow.runs;
    ASSERT_EQ(times[0].kernels.at("kernel").size(), 7u);
    EXPECT_DOUBLE_EQ(times[0].kernels.at("kernel")[3], 0.001);
    EXPECT_GT(times[0].runs[3], 4);
}

TEST(Timing, ThereAreFewerRepeatsWhereOneTakesTooLong) {
    Pretended slow(1, 50);
    const auto times = time_in_turns(std::vector<Timed>{{"slow", &slow.operation, &slow.profiler}},
                                     {.repeats = 100, .seconds = 0.02, .wall_seconds = 0.1});
    EXPECT_EQ(times[0].kernels.at("kernel").size(), 3u);
}

TEST(Timing, ManyRunsOfAShortKernelMakeARepeat) {
    Pretended quick(1, 0);
    const auto times = time_in_turns(std::vector<Timed>{{"quick", &quick.operation, &quick.profiler}},
                                     {.repeats = 3, .seconds = 0.02, .wall_seconds = 60});
    EXPECT_GE(quick.runs, 3 * 20);
    EXPECT_EQ(times[0].runs.size(), 3u);
}

TEST(Timing, OperationsWithoutTimestampsAreRefused) {
    Operation operation;
    operation.run = [] {};
    Profiler profiler;
    EXPECT_THROW(time_in_turns(std::vector<Timed>{{"none", &operation, &profiler}}, {}), DeviceError);
}

TEST(Shares, AreOfTheTimeWithoutTheLaunch) {
    KernelRow row{.kernel = "a", .milliseconds = {4, 2, 3}, .work = {.bytes = 6e9, .operations = 3e9}};
    Ceilings ceilings;
    ceilings.copy_gb_per_s = 6000;
    ceilings.fma_gflop_per_s = 30000;
    ceilings.launch_us = 1000;
    EXPECT_NEAR(shares_of(row, ceilings).of_copy, 0.5, 1e-12);  // 6 GB in 2 ms
    EXPECT_NEAR(shares_of(row, ceilings).of_multiply_add, 0.05, 1e-12);
    row.milliseconds = {1};  // nothing but a launch: a tenth of it counts
    EXPECT_NEAR(shares_of(row, ceilings).of_copy, 10, 1e-12);
}

}  // namespace
}  // namespace exemplar
