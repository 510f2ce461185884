#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gpu/runtime/kernels/layout.h"
#include "gpu/runtime/kernels/shader.h"

namespace exemplar {

struct ReflectedField {
    std::string name;
    std::size_t offset;
    std::size_t bytes;
};

enum class BindingType {
    storage,  ///< a storage buffer
    texels,   ///< a samplerBuffer or usamplerBuffer: read by texelFetch() only, through the texture units
};

VkDescriptorType descriptor_type(BindingType type);

/// A buffer binding of descriptor set 0.
struct ReflectedBinding {
    std::uint32_t binding = 0;
    std::string name;
    BindingType type = BindingType::storage;
    bool integers = false;                  ///< texels are of uints, else of floats
    VkFormat format = VK_FORMAT_UNDEFINED;  ///< of texels; not in SPIR-V, so Kernel sets it from the C++ type
    bool reads = true;
    bool writes = true;
    std::size_t stride = 0;              ///< bytes per element of the block's last array (0: none), or per texel
    std::vector<ReflectedField> fields;  ///< members of an element, if it is a structure
};

/// The interface that a shader declares.
struct Reflection {
    std::vector<ReflectedBinding> bindings;  ///< sorted by binding number
    std::size_t push_bytes = 0;
    std::vector<ReflectedField>
        push_fields;  ///< members of the push constant block, or of its only member if that is a structure
    std::array<std::uint32_t, 3> local_size{1, 1, 1};
    std::array<std::optional<std::uint32_t>, 3> local_size_ids;  ///< specialization constants that set the local size
    std::vector<std::uint32_t> constant_ids;                     ///< all specialization constants
};

/// Reads a shader's interface from Shader::words. Throws ShaderError if it is not valid SPIR-V, uses a descriptor set
/// other than 0 or binds anything but storage buffers and texel buffers.
Reflection reflect(const Shader& shader);

/// Throws ShaderError, naming the first difference, if a C++ structure differs from the shader's.
void check_layout(const Shader& shader, const std::string& where, const StructLayout& expected, std::size_t bytes,
                  const std::vector<ReflectedField>& fields);

}  // namespace exemplar
