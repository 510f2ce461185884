#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/runtime/kernels/shader.h"

namespace exemplar {

/// A compute shader of a user.
struct UserShader {
    std::string name;  ///< of its file, for messages and tables
    std::vector<std::uint32_t> words;
    Shader shader() const { return {name, words}; }
};

/// Returns the words of a SPIR-V file that a driver can be given: its header and the lengths of its instructions are
/// right, its only entry point is a compute shader called "main", and it needs no capability that devices are opened
/// without. Throws ShaderError, which names the file, the place and the mend, for any other content.
/// \note This is no validation: the rules of SPIR-V are those of spirv-val.
std::vector<std::uint32_t> checked_words(const std::string& name, std::string_view content);

}  // namespace exemplar
