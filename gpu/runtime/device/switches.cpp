#include "gpu/runtime/device/switches.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <string_view>

#include "host/core/errors.h"

namespace exemplar {
namespace {

// Returns whether a variable has the one value that it can have; not if it is empty, "0" or not set.
bool is_set(const char* variable, std::string_view value) {
    const char* text = std::getenv(variable);
    const std::string_view given = text ? text : "";
    if (given.empty() || given == "0") return false;
    if (given != value)
        throw UsageError(
            fmt::format("{}={:.40}: its only value is '{}'; unset it for the usual", variable, given, value));
    return true;
}

bool wants_validation() {
    const char* text = std::getenv("EXEMPLAR_VALIDATION");
    const std::string_view given = text ? text : "";
    return !given.empty() && given != "0";
}

}  // namespace

DeviceSwitches environment_switches() {
    return {.validates = wants_validation(),
            .maps_memory = !is_set("EXEMPLAR_MEMORY", "unmapped"),
            .prefers_host = !is_set("EXEMPLAR_HOST", "never"),
            .prefers_card_kernels = is_set("EXEMPLAR_KERNELS", "card"),
            .poisons = is_set("EXEMPLAR_POISON", "1")};
}

}  // namespace exemplar
