#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/runtime/kernels/shader.h"

namespace exemplar {

class Device;

/// A compute shader of a user.
struct UserShader {
    std::string name;  ///< of its file, for messages and tables
    std::vector<std::uint32_t> words;
    bool is_validated = false;  ///< by spirv-val
    Shader shader() const { return {name, words, words}; }
};

/// Returns the words of a SPIR-V file that a driver can be given: its header and the lengths of its instructions are
/// right, its only entry point is a compute shader called "main", and all its capabilities are known
/// (is_known_capability). Throws ShaderError, which names the file, the place and the mend, for any other content.
/// \note This is no validation: the rules of SPIR-V are those of spirv-val.
std::vector<std::uint32_t> checked_words(const std::string& name, std::string_view content);

/// Throws ShaderError if the device does not offer a capability that a checked shader needs.
void require_capabilities(const UserShader& shader, const Device& device);

}  // namespace exemplar
