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
    void SetUp() override { kept_ = testing::shared_device().tuning(); }
    void TearDown() override { testing::shared_device().tuning() = kept_; }

  private:
    Tuning kept_;
};

TEST_F(Variants, AllValuesOfAllParametersAreComparedAndTheFastestIsTaken) {
    Device& device = testing::shared_device();
    std::vector<std::string> known;
    const auto comparisons =
        compare_variants(device, kind_named("stump scoring"), 2000, KernelFilter(), k_short, known);
    ASSERT_EQ(comparisons.size(), 4u);
    EXPECT_EQ(known, std::vector<std::string>{"learn/stumps.comp"});
    for (const VariantComparison& comparison : comparisons) {
        EXPECT_GE(comparison.milliseconds.size(), 2u) << comparison.parameter;
        EXPECT_EQ(comparison.as_is.size(), k_short.repeats);
        EXPECT_EQ(device.tuning().find(comparison.kernel, comparison.parameter), comparison.chosen);
        if (!comparison.chosen) continue;
        for (const auto& [value, milliseconds] : comparison.milliseconds)
            EXPECT_LE(median(comparison.milliseconds.at(*comparison.chosen)), median(milliseconds));
    }
}

TEST_F(Variants, KnownKernelsAreLeftAlone) {
    std::vector<std::string> known{"learn/stumps.comp"};
    EXPECT_TRUE(
        compare_variants(testing::shared_device(), kind_named("stump scoring"), 500, KernelFilter(), k_short, known)
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
