#include "apps/bench/kernels/variants.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "apps/bench/kernels/statistics.h"
#include "host/core/errors.h"
#include "tests/gpu/support/environment.h"

namespace exemplar {
namespace {

constexpr TimingOptions k_short{.repeats = 2, .seconds = 1e-4};

const OperationKind& kind_named(std::string_view name) {
    return *std::ranges::find(operation_kinds(), name, &OperationKind::name);
}

// Leaves the device as it was.
class Variants : public ::testing::Test {
  protected:
    void SetUp() override { kept_ = test_support::shared_device().tuning(); }
    void TearDown() override { test_support::shared_device().tuning() = kept_; }

  private:
    Tuning kept_;
};

TEST_F(Variants, AllValuesOfAllParametersAreComparedAndTheFastestIsTaken) {
    Device& device = test_support::shared_device();
    std::vector<std::string> known;
    const auto comparisons =
        compare_variants(device, kind_named("stump scoring"), 2000, KernelFilter(), k_short, known);
    ASSERT_EQ(comparisons.size(), 4u);
    EXPECT_EQ(known, std::vector<std::string>{"learn/stumps.comp"});
    for (const VariantComparison& comparison : comparisons) {
        EXPECT_GE(comparison.milliseconds.size(), 2u) << comparison.parameter;
        EXPECT_EQ(comparison.as_is.size(), k_short.repeats);
        // What changes the host's work too is judged by all of it.
        const bool end_to_end = comparison.parameter == "bits";
        EXPECT_EQ(comparison.judged == TuningMetric::end_to_end, end_to_end) << comparison.parameter;
        EXPECT_EQ(to_json(comparison).at("times_of"), end_to_end ? "whole runs" : "the kernel");
        EXPECT_EQ(device.tuning().find(comparison.kernel, comparison.parameter), comparison.chosen);
        if (!comparison.chosen) continue;
        for (const auto& [value, milliseconds] : comparison.milliseconds)
            EXPECT_LE(median(comparison.milliseconds.at(*comparison.chosen)), median(milliseconds));
    }
}

// A whole run takes longer than its kernels, and is not among them.
TEST_F(Variants, WholeRunsAreTimedBesideTheirKernels) {
    Profiler profiler;
    const Operation operation = kind_named("stump scoring").prepare(test_support::shared_device(), profiler, 2000);
    const Timed timed{"scoring", &operation, &profiler};
    const OperationTimes times = time_in_turns(std::span(&timed, 1), k_short).front();
    ASSERT_EQ(times.kernels.size(), 1u);
    ASSERT_EQ(times.runs.size(), k_short.repeats);
    for (std::size_t i = 0; i < k_short.repeats; ++i)
        EXPECT_GT(times.runs[i], times.kernels.at("learn/stumps.comp")[i]);
}

TEST_F(Variants, KnownKernelsAreLeftAlone) {
    std::vector<std::string> known{"learn/stumps.comp"};
    EXPECT_TRUE(compare_variants(test_support::shared_device(), kind_named("stump scoring"), 500, KernelFilter(),
                                 k_short, known)
                    .empty());
}

TEST(KernelFilters, FindKernelsOrOperations) {
    const OperationKind& scoring = kind_named("stump scoring");
    EXPECT_TRUE(KernelFilter("stumps").wants(scoring));
    EXPECT_TRUE(KernelFilter("^stump scoring$").wants(scoring, "learn/stumps.comp"));
    EXPECT_FALSE(KernelFilter("reproject").wants(scoring));
    EXPECT_THROW(KernelFilter("["), UsageError);
    EXPECT_THROW(KernelFilter("no such kernel"), UsageError);
}

}  // namespace
}  // namespace exemplar
