#include "gpu/runtime/device/switches.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "host/core/errors.h"

namespace exemplar {
namespace {

// Returns the value of a variable; empty if it is "0" or not set.
std::string_view value_of(const char* variable) {
    const char* text = std::getenv(variable);
    const std::string_view value = text ? text : "";
    return value == "0" ? "" : value;
}

// Returns whether a variable has the one value that it can have.
bool is_set(const char* variable, std::string_view only) {
    const std::string_view value = value_of(variable);
    if (!value.empty() && value != only)
        throw UsageError(
            fmt::format("{}={:.40}: its only value is '{}'; unset it for the usual", variable, value, only));
    return !value.empty();
}

}  // namespace

DeviceSwitches environment_switches() {
    const std::string_view validation = value_of("EXEMPLAR_VALIDATION");
    const bool checks_shaders = validation == "gpu";
    if (!validation.empty() && !checks_shaders && validation != "1")
        throw UsageError(fmt::format("EXEMPLAR_VALIDATION={:.40}: its values are '1' and 'gpu'; unset it for the usual",
                                     validation));
    return {.validates = !validation.empty(),
            .checks_shaders = checks_shaders,
            .maps_memory = !is_set("EXEMPLAR_MEMORY", "unmapped"),
            .prefers_host = !is_set("EXEMPLAR_HOST", "never"),
            .prefers_card_kernels = is_set("EXEMPLAR_KERNELS", "card"),
            .poisons = is_set("EXEMPLAR_POISON", "1")};
}

}  // namespace exemplar
