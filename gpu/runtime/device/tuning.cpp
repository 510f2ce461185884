#include "gpu/runtime/device/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <system_error>

#include "gpu/runtime/device/device_cache.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"

namespace exemplar {

std::optional<std::uint32_t> Tuning::find(std::string_view kernel, std::string_view parameter) const {
    const auto of_kernel = kernels_.find(kernel);
    if (of_kernel == kernels_.end()) return std::nullopt;
    const auto value = of_kernel->second.find(parameter);
    if (value == of_kernel->second.end()) return std::nullopt;
    return value->second;
}

std::uint32_t Tuning::choose(std::string_view kernel, const TunableParameter& parameter,
                             std::uint32_t otherwise) const {
    const std::optional<std::uint32_t> kept = find(kernel, parameter.name);
    return kept && std::ranges::find(parameter.values, *kept) != parameter.values.end() ? *kept : otherwise;
}

void Tuning::set(std::string_view kernel, std::string_view parameter, std::uint32_t value) {
    kernels_[std::string(kernel)][std::string(parameter)] = value;
}

void Tuning::forget(std::string_view kernel, std::string_view parameter) {
    const auto of_kernel = kernels_.find(kernel);
    if (of_kernel == kernels_.end()) return;
    const auto value = of_kernel->second.find(parameter);
    if (value != of_kernel->second.end()) of_kernel->second.erase(value);
    if (of_kernel->second.empty()) kernels_.erase(of_kernel);
}

Tuning Tuning::load(const std::filesystem::path& path) {
    Tuning tuning;
    std::error_code error;
    if (path.empty() || !std::filesystem::exists(path, error)) return tuning;
    try {
        tuning.kernels_ = parse_json(read_file(path)).at("kernels").get<decltype(kernels_)>();
    } catch (const nlohmann::json::exception&) {
        throw DataError(
            fmt::format("{}: this is no tuning of kernels; delete it, or write it anew with 'exemplar bench "
                        "shaders --tune'",
                        path.string()));
    }
    return tuning;
}

void Tuning::save(const std::filesystem::path& path) const {
    const std::string text = json_text(nlohmann::json{{"kernels", kernels_}}, 2);
    write_file_atomically(path, [&](std::ostream& out) { out << text << '\n'; });
}

std::filesystem::path tuning_path(const DeviceInfo& info) {
    return device_cache_path(info, "tuning", "json");
}

}  // namespace exemplar
