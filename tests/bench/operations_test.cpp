#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <string>

#include "apps/bench/kernels/operation.h"
#include "host/core/files.h"
#include "host/core/stopwatch.h"
#include "tests/gpu/support/environment.h"

namespace exemplar {
namespace {

std::set<std::string> measured_kernels() {
    std::set<std::string> names;
    for (const OperationKind& kind : operation_kinds())
        for (const Shader* kernel : kind.kernels) names.emplace(kernel->name);
    return names;
}

TEST(Operations, EveryKernelIsPartOfOne) {
    std::set<std::string> shaders;
    for (const auto& entry : std::filesystem::recursive_directory_iterator("shaders"))
        if (entry.path().extension() == ".comp" && entry.path().parent_path().filename() != "tests")
            shaders.insert(std::filesystem::relative(entry.path(), "shaders").string());
    ASSERT_GT(shaders.size(), 40u);
    EXPECT_EQ(measured_kernels(), shaders);
}

TEST(Operations, EveryKernelIsDocumented) {
    const std::string docs = read_file("docs/shaders.md");
    for (const std::string& kernel : measured_kernels())
        EXPECT_NE(docs.find("`" + kernel + "`"), std::string::npos) << kernel;
}

TEST(Operations, ParametersAreOfTheirKernels) {
    for (const OperationKind& kind : operation_kinds())
        for (const TunableParameter& parameter : kind.parameters)
            EXPECT_TRUE(std::ranges::any_of(kind.kernels,
                                            [&](const Shader* kernel) { return kernel->name == parameter.kernel; }))
                << kind.name << ": " << parameter.kernel;
}

// Of a kernel that takes some ten milliseconds on a CPU, most of the way there and back is its own time.
TEST(Profiling, KernelsAreTimedRightlyAfterSomethingWasDrawn) {
    Device& device = test_support::shared_device();
    if (device.info().type != DeviceType::cpu) GTEST_SKIP() << "on GPUs the way there may take longer than the kernel";
    const auto prepared = [&](std::string_view name, Profiler& profiler, std::size_t size) {
        return std::ranges::find(operation_kinds(), name, &OperationKind::name)->prepare(device, profiler, size);
    };
    Profiler drawing, calculating;
    prepared("shaded pictures", drawing, 10'000).run();
    const Operation operation = prepared("multiply-adds", calculating, 131'072);
    operation.run();
    double largest_share = 0;  // of several runs, as another process may take the processor's time in between
    for (int run = 0; run < 20; ++run) {
        calculating.reset();
        const Stopwatch watch;
        operation.run();
        const double wall = 1e3 * watch.wall(), kernel = calculating.milliseconds("runtime/multiply_add.comp");
        EXPECT_LT(kernel, 1.01 * wall);
        largest_share = std::max(largest_share, kernel / wall);
    }
    EXPECT_GT(largest_share, 0.5);
}

class OperationTest : public ::testing::TestWithParam<std::size_t> {
  protected:
    const OperationKind& kind() const { return operation_kinds()[GetParam()]; }
};

// Sizes that are no multiples of a workgroup, far below those that are measured.
TEST_P(OperationTest, AgreesWithItsReferenceAtOddSizes) {
    for (const std::size_t size : {std::size_t{67}, std::size_t{1003}, std::size_t{4097}}) {
        SCOPED_TRACE(::testing::Message() << kind().name << ", " << size);
        Profiler profiler;
        const Operation operation = kind().prepare(test_support::shared_device(), profiler, size);
        operation.run();
        operation.run();
        const auto differences = operation.differences();
        EXPECT_FALSE(differences.empty());
        for (const Difference& difference : differences)
            EXPECT_TRUE(difference.fits())
                << difference.of << ": " << difference.largest << ", allowed is " << difference.tolerance;
    }
}

TEST_P(OperationTest, RunsTheKernelsThatItSaysAndKnowsTheirWork) {
    Profiler profiler;
    const Operation operation = kind().prepare(test_support::shared_device(), profiler, 1003);
    operation.run();
    std::set<std::string> expected, ran, worked;
    for (const Shader* kernel : kind().kernels) expected.emplace(kernel->name);
    for (const auto& [kernel, entry] : profiler.entries())
        if (kernel.ends_with(".comp")) ran.insert(kernel);  // what is drawn is timed too
    for (const auto& [kernel, work] : operation.work()) {
        worked.insert(kernel);
        EXPECT_TRUE(work.bytes > 0 || kernel == "runtime/empty.comp") << kernel;
        EXPECT_GE(work.operations, 0) << kernel;
    }
    EXPECT_EQ(ran, expected);
    EXPECT_EQ(worked, expected);
}

std::string test_name(const ::testing::TestParamInfo<std::size_t>& info) {
    std::string name(operation_kinds()[info.param].name);
    std::ranges::replace_if(
        name, [](unsigned char c) { return !std::isalnum(c); }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(All, OperationTest, ::testing::Range(std::size_t{0}, operation_kinds().size()), test_name);

}  // namespace
}  // namespace exemplar
