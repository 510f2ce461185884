#include "apps/bench/kernels/compiler_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <set>

#include "gpu/runtime/device/tuning.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/kernels/reflection.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "tests/gpu/support/environment.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

std::set<std::uint32_t> ids_of(const CompiledVariant& variant) {
    std::set<std::uint32_t> ids;
    for (const auto& [id, value] : variant.constants) ids.insert(id);
    return ids;
}

TEST(CompiledVariants, EveryKernelHasADefault) {
    std::set<std::string_view> kernels, with_default;
    for (const OperationKind& kind : operation_kinds())
        for (const Shader* kernel : kind.kernels) kernels.insert(kernel->name);
    for (const CompiledVariant& variant : compiled_variants(KernelFilter()))
        if (variant.is_default) with_default.insert(variant.kernel->name);
    EXPECT_EQ(with_default, kernels);
}

TEST(CompiledVariants, TheyDiffer) {
    std::set<std::pair<std::string_view, std::string>> seen;
    for (const CompiledVariant& variant : compiled_variants(KernelFilter()))
        EXPECT_TRUE(seen.emplace(variant.kernel->name, variant.name).second)
            << variant.kernel->name << ' ' << variant.name;
}

// A constant that is missing in the list would be compiled with the value of the shader's source only.
TEST(CompiledVariants, TheyHaveAllConstantsOfTheirKernels) {
    for (const CompiledVariant& variant : compiled_variants(KernelFilter())) {
        const Reflection reflection = reflect(*variant.kernel);
        std::set<std::uint32_t> expected(reflection.constant_ids.begin(), reflection.constant_ids.end()),
            found = ids_of(variant);
        expected.erase(k_group_size_constant);
        found.erase(k_group_size_constant);
        EXPECT_EQ(found, expected) << variant.kernel->name << ' ' << variant.name;
    }
}

TEST(CompiledVariants, AllValuesThatTuningMayChooseAreAmongThem) {
    const std::vector<CompiledVariant> variants = compiled_variants(KernelFilter());
    const auto is_known = [&](std::string_view kernel, std::string_view parameter, std::uint32_t value) {
        const std::string text = std::string(parameter) + ' ' + std::to_string(value);
        return std::ranges::any_of(variants, [&](const CompiledVariant& variant) {
            return variant.kernel->name == kernel &&
                   (", " + variant.name + ',').find(", " + text + ',') != std::string::npos;
        });
    };
    for (const OperationKind& kind : operation_kinds())
        for (const TunableParameter& parameter : kind.parameters)
            for (const std::uint32_t value : parameter.values)
                EXPECT_TRUE(is_known(parameter.kernel, parameter.name, value))
                    << parameter.kernel << ' ' << parameter.name << ' ' << value;
    EXPECT_TRUE(is_known("lines/gather.comp", k_group_size.name, 512));
}

TEST(CompiledVariants, ShadersCompileWithoutTheirInterface) {
    Device& device = test_support::shared_device();
    for (const CompiledVariant& variant : compiled_variants(KernelFilter("copy|scan")))
        EXPECT_NO_THROW(compile(device, *variant.kernel, variant.constants)) << variant.kernel->name;
}

CodeStatistics code(std::uint64_t scratch, std::uint64_t subgroups, std::uint64_t inverse_throughput) {
    return {
        .kernel = "a.comp",
        .variant = "quads 1",
        .is_default = true,
        .numbers = {
            {"scratch_bytes", scratch}, {"subgroups_per_simd", subgroups}, {"inverse_throughput", inverse_throughput}}};
}

FamilyStatistics family(const CodeStatistics& kernel) {
    return {.family = "NAVI21", .device = "a card", .driver = "Mesa 1", .kernels = {kernel}};
}

std::vector<CodeChange> changes(const CodeStatistics& now, const CodeStatistics& before) {
    return changes_between(family(now), family(before));
}

TEST(CodeChanges, EqualCodeHasNone) {
    EXPECT_TRUE(changes(code(0, 8, 1000), code(0, 8, 1000)).empty());
}

TEST(CodeChanges, EveryChangedNumberIsFound) {
    const auto found = changes(code(0, 9, 1001), code(64, 8, 1000));
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].number, "scratch_bytes");
    EXPECT_EQ(found[0].before, 64u);
    EXPECT_EQ(found[0].now, 0u);
    EXPECT_EQ(std::ranges::count(found, true, &CodeChange::is_worse), 0);
}

TEST(CodeChanges, ScratchOccupancyAndThroughputMayNotBecomeWorse) {
    EXPECT_TRUE(changes(code(16, 8, 1000), code(0, 8, 1000)).at(0).is_fault());
    EXPECT_TRUE(changes(code(0, 7, 1000), code(0, 8, 1000)).at(0).is_fault());
    EXPECT_FALSE(changes(code(0, 8, 1030), code(0, 8, 1000)).at(0).is_fault());
    EXPECT_TRUE(changes(code(0, 8, 1031), code(0, 8, 1000)).at(0).is_fault());
}

TEST(CodeChanges, VariantsOfTuningMayBecomeWorse) {
    CodeStatistics now = code(16, 8, 1000);
    now.is_default = false;
    EXPECT_FALSE(changes(now, code(0, 8, 1000)).at(0).is_worse);
}

TEST(CodeChanges, WhatIsAcceptedIsNoFault) {
    CodeStatistics before = code(0, 8, 1000);
    before.accepted = "many classes";
    const auto found = changes(code(16, 8, 1000), before);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(found[0].is_worse);
    EXPECT_EQ(found[0].accepted, "many classes");
    EXPECT_FALSE(found[0].is_fault());
}

TEST(CodeChanges, VariantsOfTuningNeedNoBaseline) {
    CodeStatistics now = code(16, 8, 1000);
    now.is_default = false;
    now.variant = "quads 2";
    EXPECT_TRUE(changes(now, code(0, 8, 1000)).empty());
}

TEST(CodeChanges, ANewKernelMayHaveNoScratch) {
    CodeStatistics other = code(0, 8, 1000);
    other.kernel = "b.comp";
    EXPECT_TRUE(changes(code(0, 1, 9999), other).empty());
    EXPECT_TRUE(changes(code(16, 1, 9999), other).at(0).is_fault());
}

TEST(CodeChanges, NumbersThatTheBaselineLacksAreNotCompared) {
    CodeStatistics before = code(0, 8, 1000);
    before.numbers.erase("scratch_bytes");
    EXPECT_TRUE(changes(code(16, 8, 1000), before).empty());
}

TEST(CodeStatistics, ReportsAreReadAsWritten) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "statistics.json";
    write_file_atomically(path, [](std::ostream& out) {
        out << nlohmann::ordered_json{{"families", {to_json(family(code(16, 8, 1000)))}}};
    });
    const std::vector<FamilyStatistics> read = read_statistics(path);
    ASSERT_EQ(read.size(), 1u);
    EXPECT_EQ(read[0].family, "NAVI21");
    EXPECT_EQ(read[0].driver, "Mesa 1");
    ASSERT_EQ(read[0].kernels.size(), 1u);
    EXPECT_EQ(read[0].kernels[0].variant, "quads 1");
    EXPECT_TRUE(read[0].kernels[0].is_default);
    EXPECT_EQ(read[0].kernels[0].numbers, code(16, 8, 1000).numbers);
    write_file_atomically(path, [](std::ostream& out) { out << "{}"; });
    EXPECT_THROW(read_statistics(path), DataError);
}

}  // namespace
}  // namespace exemplar
