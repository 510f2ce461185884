#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/spirv/user_measurement.h"
#include "apps/exemplar/bench/bench_statistics.h"
#include "apps/exemplar/common_options.h"

namespace exemplar {

/// Options of `exemplar bench spirv`, as they are given.
struct SpirvOptions {
    CommonOptions common;
    std::filesystem::path shader, against;
    std::vector<std::filesystem::path> includes;
    std::vector<std::string> binds, specs, against_specs, expects, texels;
    std::string groups, invocations, against_groups, push;
    double tolerance = 1e-5;
    double bytes = 0, operations = 0;  ///< of a dispatch; 0: the bytes bound, no operations
    std::size_t repeats = 7;
    double seconds = 10;
    bool keeps = false, statistics = false, in_this_process = false;
    StatisticsOptions compiling;
    std::filesystem::path baseline;
};

/// A user's shader and how it is started.
struct SpirvVersion {
    UserShader shader;
    UserDispatch dispatch;
    UserInterface interface;
    Bytes push;
};

/// The shaders to measure: one, or two with the same inputs.
struct SpirvJob {
    std::vector<SpirvVersion> versions;
    std::vector<BindingSource> sources;
    std::vector<std::pair<std::uint32_t, std::filesystem::path>> expected;
};

/// Reads the shaders, and the options by what they declare. Throws UsageError, ShaderError or DataError, which name the
/// option or file and the mend.
SpirvJob read_spirv_job(const SpirvOptions& options);

/// Prints what the compiler of graphics cards tells of the shaders (--statistics).
void run_spirv_statistics(const SpirvOptions& options);

}  // namespace exemplar
