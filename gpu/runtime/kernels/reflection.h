#pragma once

#include <volk.h>

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
    bool integers = false;                  ///< what texels are made of: uint, else float
    VkFormat format = VK_FORMAT_UNDEFINED;  ///< of texels; no shader says it, so Kernel sets it from their C++ type
    bool reads = true;
    bool writes = true;
    std::size_t stride = 0;              ///< of the array that ends the block; 0 if there is none; of texels as format
    std::vector<ReflectedField> fields;  ///< of an element, if it is a structure
};

/// What a compute shader declares.
struct Reflection {
    std::vector<ReflectedBinding> bindings;  ///< by rising binding number
    std::size_t push_bytes = 0;
    std::vector<ReflectedField>
        push_fields;  ///< of the structure that is the push constant block's only member, else of the block
    std::array<std::uint32_t, 3> local_size{1, 1, 1};
    std::array<std::optional<std::uint32_t>, 3> local_size_ids;  ///< specialization constants that set the local size
    std::vector<std::uint32_t> constant_ids;                     ///< all specialization constants
};

/// Reads a compute shader's interface. Throws ShaderError if it is no valid SPIR-V, uses another descriptor set than 0
/// or binds anything but storage buffers and texel buffers.
Reflection reflect(const Shader& shader);

/// Throws ShaderError naming the first difference between a structure of C++ and the shader's.
void check_layout(const Shader& shader, const std::string& where, const StructLayout& expected, std::size_t bytes,
                  const std::vector<ReflectedField>& fields);

}  // namespace exemplar
