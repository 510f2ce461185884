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

/// What a variant is judged by: the time of its kernel, or that of whole runs, where the host's work differs too.
enum class Judged { by_kernel, by_runs };

/// A number that kernels are compiled with and that changes their speed, not what they compute (but for the order of
/// sums).
struct TunableParameter {
    std::string_view kernel;  ///< as "learn/stumps.comp"; the group size, k_group_size, is that of any
    std::string_view name;
    std::span<const std::uint32_t> values;  ///< all that it may be
    Judged judged = Judged::by_kernel;
};

/// Invocations per workgroup, of kernels that leave it to the host: their local_size_x is specialization constant
/// k_group_size_constant.
inline constexpr std::array<std::uint32_t, 6> k_group_sizes{16, 32, 64, 128, 256, 512};
inline constexpr TunableParameter k_group_size{"", "group", k_group_sizes};
inline constexpr std::uint32_t k_group_size_constant = 100;

/// The variants of kernels that were found fastest on a device (`exemplar bench shaders --tune`). What is not there is
/// as the kernel's author chose.
class Tuning {
  public:
    /// The value kept for a kernel's parameter if it is one of the parameter's values, else `otherwise`.
    std::uint32_t choose(std::string_view kernel, const TunableParameter& parameter, std::uint32_t otherwise) const;
    std::uint32_t choose(const TunableParameter& parameter, std::uint32_t otherwise) const {
        return choose(parameter.kernel, parameter, otherwise);
    }
    /// What was kept, whether or not it is a possible value.
    std::optional<std::uint32_t> find(std::string_view kernel, std::string_view parameter) const;
    void set(std::string_view kernel, std::string_view parameter, std::uint32_t value);
    void forget(std::string_view kernel, std::string_view parameter);
    bool empty() const { return kernels_.empty(); }

    /// Reads what save() has written; no file is an empty tuning. Throws DataError, naming the file and the mend, if it
    /// is damaged.
    static Tuning load(const std::filesystem::path& path);
    /// Throws DataError if the file cannot be written.
    void save(const std::filesystem::path& path) const;

    bool operator==(const Tuning&) const = default;

  private:
    std::map<std::string, std::map<std::string, std::uint32_t, std::less<>>, std::less<>> kernels_;
};

/// Where the tuning of a device lives (device_cache_path); empty if there is no folder.
std::filesystem::path tuning_path(const DeviceInfo& info);

}  // namespace exemplar
