#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "gpu/runtime/device/device_info.h"

namespace exemplar {

/// Time by which variants are compared: that of the kernel, or that of whole runs if the host's work differs too.
enum class TuningMetric { kernel_time, end_to_end };

/// A constant that kernels are compiled with. It affects their speed but not their results, except for the order of
/// sums.
struct TunableParameter {
    std::string_view kernel;  ///< as "learn/stumps.comp"; empty for k_group_size, which is for any kernel
    std::string_view name;
    std::span<const std::uint32_t> values;    ///< all possible values
    std::uint32_t on_cpus = 0, on_cards = 0;  ///< defaults; k_group_size has none, as shaders declare their size
    TuningMetric judged = TuningMetric::kernel_time;
};

/// Possible numbers of invocations per workgroup, for kernels that leave it to the host: their local_size_x is the
/// specialization constant k_group_size_constant.
inline constexpr std::array<std::uint32_t, 6> k_group_sizes{16, 32, 64, 128, 256, 512};
inline constexpr TunableParameter k_group_size{"", "group", k_group_sizes};
inline constexpr std::uint32_t k_group_size_constant = 100;

/// Notes the SPIR-V of an embedded shader, so that tuning files forget what was found for another version of it.
/// Embedded shaders call it before main(). Returns true.
bool note_shader(std::string_view name, std::span<const std::uint32_t> words, std::span<const std::uint32_t> cpu_words);

/// Fastest known kernel variants of one device (`exemplar bench shaders --tune`). Parameters without an entry use the
/// kernel's default.
class Tuning {
  public:
    /// Returns the stored value of a kernel's parameter if it is one of the parameter's values, else `otherwise`.
    std::uint32_t choose(std::string_view kernel, const TunableParameter& parameter, std::uint32_t otherwise) const;
    std::uint32_t choose(const TunableParameter& parameter, std::uint32_t otherwise) const {
        return choose(parameter.kernel, parameter, otherwise);
    }
    /// Returns the stored value, even if it is not a possible one.
    std::optional<std::uint32_t> find(std::string_view kernel, std::string_view parameter) const;
    void set(std::string_view kernel, std::string_view parameter, std::uint32_t value);
    void forget(std::string_view kernel, std::string_view parameter);
    bool empty() const { return kernels_.empty(); }

    /// Reads a file written by save(); a missing file gives an empty tuning. Leaves out kernels whose SPIR-V has
    /// changed since, and all of a file without the hashes of SPIR-V, as earlier versions wrote it. Throws DataError,
    /// which names the file and the remedy, if it is damaged.
    static Tuning load(const std::filesystem::path& path);
    /// Throws DataError if the file cannot be written.
    void save(const std::filesystem::path& path) const;

    bool operator==(const Tuning&) const = default;

  private:
    std::map<std::string, std::map<std::string, std::uint32_t, std::less<>>, std::less<>> kernels_;
};

/// Returns the path of a device's tuning file (device_cache_path); empty if there is no cache folder.
std::filesystem::path tuning_path(const DeviceInfo& info);

}  // namespace exemplar
