#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/bench/kernels/compiled_variants.h"
#include "gpu/runtime/device/executable_statistics.h"

namespace exemplar {

/// A number that a driver tells of compiled code.
struct CodeNumber {
    const char* key;     ///< in JSON
    const char* driver;  ///< the name that Mesa's RADV gives it
    const char* header;  ///< of its column in the printed table; null if it has none
};
inline constexpr std::array<CodeNumber, 13> k_code_numbers{
    {{"vgprs", "VGPRs", "VGPRs"},
     {"sgprs", "SGPRs", "SGPRs"},
     {"spilled_vgprs", "Spilled VGPRs", "spilled"},
     {"spilled_sgprs", "Spilled SGPRs", "spilled S"},
     {"scratch_bytes", "Scratch size", "scratch"},
     {"lds_bytes", "LDS size", "LDS"},
     {"subgroups_per_simd", "Subgroups per SIMD", "subgroups"},
     {"code_bytes", "Code size", "bytes"},
     {"instructions", "Instructions", "instructions"},
     {"copies", "Copies", nullptr},
     {"branches", "Branches", nullptr},
     {"latency", "Latency", "latency"},
     {"inverse_throughput", "Inverse Throughput", "1/throughput"}}};

/// The numbers of one variant of a kernel.
struct CodeStatistics {
    std::string kernel, variant;
    bool is_default = false;
    std::map<std::string, std::uint64_t> numbers;  ///< by key; of a baseline, only some
    std::string accepted{};                        ///< of a baseline: why this variant may become worse
};

/// The numbers of all variants, as compiled for one family of graphics cards.
struct FamilyStatistics {
    std::string family, device, driver;
    std::vector<CodeStatistics> kernels;
};

/// Compiles a variant. The device must have been opened with DeviceOptions::statistics.
CodeStatistics compile_variant(Device& device, const CompiledVariant& variant);

nlohmann::ordered_json to_json(const FamilyStatistics& statistics);
/// Reads what to_json() wrote. Throws nlohmann::json::exception for anything else.
FamilyStatistics family_statistics(const nlohmann::json& json);
/// Reads a report of `exemplar bench shaders --statistics --json`. Throws DataError naming the file if it is none.
std::vector<FamilyStatistics> read_statistics(const std::filesystem::path& path);

/// A number that differs between two compilations.
struct CodeChange {
    std::string kernel, variant;
    std::string number;  ///< its key
    std::uint64_t before = 0, now = 0;
    /// Whether it is a default variant that has more spills or scratch, fewer subgroups per SIMD, or an inverse
    /// throughput that is more than 3 % larger.
    bool is_worse = false;
    std::string accepted;  ///< why that is accepted; empty if it is not

    bool is_fault() const { return is_worse && accepted.empty(); }
};

/// Returns the changes of all numbers that both have. Default variants that `before` lacks are compared with code that
/// needs neither spills nor scratch; other variants that it lacks are not compared.
std::vector<CodeChange> changes_between(const FamilyStatistics& now, const FamilyStatistics& before);

}  // namespace exemplar
