#include "gpu/runtime/device/tuning.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <ostream>
#include <system_error>

#include "gpu/runtime/device/device_cache.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"

namespace exemplar {
namespace {

// The builds of a shader, for cards and for CPU drivers.
using ShaderBuilds = std::array<std::span<const std::uint32_t>, 2>;

std::map<std::string_view, ShaderBuilds>& noted_shaders() {
    static std::map<std::string_view, ShaderBuilds> shaders;
    return shaders;
}

// Returns the hash of a kernel's SPIR-V; an empty text for a kernel that is not part of this program.
std::string shader_hash(std::string_view kernel) {
    const auto shader = noted_shaders().find(kernel);
    if (shader == noted_shaders().end()) return {};
    XXH64_hash_t hash = 0;
    for (const std::span<const std::uint32_t> words : shader->second)
        hash = XXH3_64bits_withSeed(words.data(), words.size_bytes(), hash);
    return fmt::format("{:016x}", hash);
}

}  // namespace

bool note_shader(std::string_view name, std::span<const std::uint32_t> words,
                 std::span<const std::uint32_t> cpu_words) {
    return noted_shaders().emplace(name, ShaderBuilds{words, cpu_words}).second;
}

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
        const nlohmann::json json = parse_json(read_file(path));
        tuning.kernels_ = json.at("kernels").get<decltype(kernels_)>();
        const auto hashes = json.value("shaders", std::map<std::string, std::string>());
        std::erase_if(tuning.kernels_, [&](const auto& kernel) {
            const auto hash = hashes.find(kernel.first);
            return hash == hashes.end() || hash->second != shader_hash(kernel.first);
        });
    } catch (const nlohmann::json::exception&) {
        throw DataError(
            fmt::format("{}: this is no tuning of kernels; delete it, or write it anew with 'exemplar bench "
                        "shaders --tune'",
                        path.string()));
    }
    return tuning;
}

void Tuning::save(const std::filesystem::path& path) const {
    std::map<std::string, std::string> hashes;
    for (const auto& [kernel, parameters] : kernels_) hashes[kernel] = shader_hash(kernel);
    const std::string text = json_text(nlohmann::json{{"kernels", kernels_}, {"shaders", hashes}}, 2);
    write_file_atomically(path, [&](std::ostream& out) { out << text << '\n'; });
}

std::filesystem::path tuning_path(const DeviceInfo& info) {
    return device_cache_path(info, "tuning", "json");
}

}  // namespace exemplar
