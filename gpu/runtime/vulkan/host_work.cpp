#include "gpu/runtime/vulkan/host_work.h"

namespace exemplar {

std::string_view plural_name(HostTask task) {
    constexpr std::array<std::string_view, k_host_tasks> k_names{
        "submissions", "waits",   "dispatches", "passes",          "barriers", "copies",    "copied regions",
        "allocations", "buffers", "views",      "descriptor sets", "bytes up", "bytes down"};
    return k_names[static_cast<std::size_t>(task)];
}

}  // namespace exemplar
