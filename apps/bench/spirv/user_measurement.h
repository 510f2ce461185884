#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/bench/kernels/measurement.h"
#include "apps/bench/kernels/statistics.h"
#include "apps/bench/spirv/comparison.h"
#include "apps/bench/spirv/user_kernel.h"

namespace exemplar {

/// A binding compared with what is expected of it.
struct CheckedBinding {
    std::uint32_t binding = 0;
    std::string name;
    std::string with;  ///< the file, or the other shader
    BufferComparison comparison;
};

/// Compares the written bindings of a kernel that has run with those of another one. Both must have the same.
std::vector<CheckedBinding> compare_outputs(const UserKernel& kernel, const UserKernel& other,
                                            const UserInterface& interface, const std::string& with, double tolerance);

/// Compares a binding of a kernel that has run with a file. Throws UsageError if their sizes differ.
CheckedBinding compare_with_file(const UserKernel& kernel, const UserInterface& interface, std::uint32_t binding,
                                 const std::filesystem::path& path, double tolerance);

/// Times kernels in turns with each other and with those that only copy, or multiply and add. Kernels that take less
/// than a millisecond are dispatched several times in one submission. Returns a row per kernel; `work` is that of one
/// dispatch of any of them.
Measurement time_kernels(Device& device, const std::vector<std::pair<std::string, UserKernel*>>& kernels,
                         const Work& work, const TimingOptions& options, const Ceilings& ceilings);

}  // namespace exemplar
