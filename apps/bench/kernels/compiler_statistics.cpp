#include "apps/bench/kernels/compiler_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "gpu/runtime/kernels/kernel.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"

namespace exemplar {
namespace {

constexpr double k_tolerated_growth = 1.03;

bool must_not_grow(std::string_view number) {
    return number.starts_with("spilled_") || number == "scratch_bytes";
}

bool is_worse(const CodeChange& change) {
    if (must_not_grow(change.number)) return change.now > change.before;
    if (change.number == "subgroups_per_simd") return change.now < change.before;
    if (change.number == "inverse_throughput")
        return static_cast<double>(change.now) > k_tolerated_growth * static_cast<double>(change.before);
    return false;
}

// Code that a variant without a baseline is compared with.
CodeStatistics blameless(const CodeStatistics& now) {
    CodeStatistics result = now;
    for (auto& [number, value] : result.numbers)
        if (must_not_grow(number)) value = 0;
    return result;
}

void add_changes(const CodeStatistics& now, const CodeStatistics& before, std::vector<CodeChange>& changes) {
    for (const CodeNumber& number : k_code_numbers) {
        const auto old_value = before.numbers.find(number.key), value = now.numbers.find(number.key);
        if (old_value == before.numbers.end() || value == now.numbers.end() || old_value->second == value->second)
            continue;
        CodeChange change{.kernel = now.kernel,
                          .variant = now.variant,
                          .number = number.key,
                          .before = old_value->second,
                          .now = value->second,
                          .is_worse = false,
                          .accepted = before.accepted};
        change.is_worse = now.is_default && is_worse(change);
        changes.push_back(std::move(change));
    }
}

CodeStatistics code_statistics(const nlohmann::json& json) {
    CodeStatistics result{.kernel = json.at("kernel"),
                          .variant = json.at("variant"),
                          .is_default = json.at("default"),
                          .numbers = {},
                          .accepted = json.value("accepted", "")};
    for (const CodeNumber& number : k_code_numbers)
        if (json.contains(number.key)) json.at(number.key).get_to(result.numbers[number.key]);
    return result;
}

}  // namespace

CodeStatistics compile_variant(Device& device, const CompiledVariant& variant) {
    CodeStatistics result{.kernel = std::string(variant.kernel->name),
                          .variant = variant.name,
                          .is_default = variant.is_default,
                          .numbers = {}};
    for (const auto& [name, text] : compile(device, *variant.kernel, variant.constants)) {
        const auto known = std::ranges::find(k_code_numbers, name, &CodeNumber::driver);
        if (known == k_code_numbers.end()) continue;
        std::from_chars(text.data(), text.data() + text.size(), result.numbers[known->key]);
    }
    return result;
}

nlohmann::ordered_json to_json(const FamilyStatistics& statistics) {
    nlohmann::ordered_json kernels = nlohmann::ordered_json::array();
    for (const CodeStatistics& code : statistics.kernels) {
        kernels.push_back({{"kernel", code.kernel}, {"variant", code.variant}, {"default", code.is_default}});
        for (const CodeNumber& number : k_code_numbers)
            if (const auto value = code.numbers.find(number.key); value != code.numbers.end())
                kernels.back()[number.key] = value->second;
    }
    return {{"family", statistics.family},
            {"device", statistics.device},
            {"driver", statistics.driver},
            {"kernels", std::move(kernels)}};
}

FamilyStatistics family_statistics(const nlohmann::json& json) {
    FamilyStatistics result{
        .family = json.at("family"), .device = json.at("device"), .driver = json.at("driver"), .kernels = {}};
    result.kernels.reserve(json.at("kernels").size());
    for (const nlohmann::json& code : json.at("kernels")) result.kernels.push_back(code_statistics(code));
    return result;
}

std::vector<FamilyStatistics> read_statistics(const std::filesystem::path& path) {
    try {
        const nlohmann::json json = parse_json(read_file(path));
        std::vector<FamilyStatistics> families;
        for (const nlohmann::json& family : json.at("families")) families.push_back(family_statistics(family));
        return families;
    } catch (const nlohmann::json::exception&) {
        throw DataError(fmt::format(
            "{}: this is no report of 'exemplar bench shaders --statistics'; make one with --json", path.string()));
    }
}

std::vector<CodeChange> changes_between(const FamilyStatistics& now, const FamilyStatistics& before) {
    std::vector<CodeChange> changes;
    for (const CodeStatistics& code : now.kernels) {
        const auto old_code = std::ranges::find_if(before.kernels, [&](const CodeStatistics& other) {
            return other.kernel == code.kernel && other.variant == code.variant;
        });
        if (old_code != before.kernels.end())
            add_changes(code, *old_code, changes);
        else if (code.is_default)
            add_changes(code, blameless(code), changes);
    }
    return changes;
}

}  // namespace exemplar
