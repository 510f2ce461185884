#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/kernels/measurement.h"

namespace exemplar {

/// A kernel with values of its specialization constants, as programs compile it.
struct CompiledVariant {
    const Shader* kernel;
    std::string name;         ///< "quads 1, bits 32"; empty if the kernel has no constants
    bool is_default = false;  ///< graphics cards run it unless tuning has found a faster one
    std::vector<std::pair<std::uint32_t, std::uint32_t>> constants;  ///< id and bits
};

/// Returns all variants of the kernels that the filter selects, the kernels in the order of operation_kinds(). Values
/// of the tunable parameters are combined with each other and with the constants that programs choose. Group sizes are
/// combined with the defaults only.
std::vector<CompiledVariant> compiled_variants(const KernelFilter& filter);

}  // namespace exemplar
