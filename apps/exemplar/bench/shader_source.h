#pragma once

#include <filesystem>
#include <vector>

#include "apps/bench/spirv/module_check.h"

namespace exemplar {

/// Reads a user's compute shader: SPIR-V, or GLSL (.comp, .glsl) that glslangValidator compiles, with `includes` as
/// folders of #include. Validates SPIR-V with spirv-val where it is installed. Throws UsageError, ShaderError or
/// DataError, naming file and mend, if it cannot be used; prints further lines of the compiler on stderr.
UserShader load_user_shader(const std::filesystem::path& path, const std::vector<std::filesystem::path>& includes);

}  // namespace exemplar
