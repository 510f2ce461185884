#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/runtime/kernels/shader.h"

namespace exemplar {

enum class ScalarType {
    float32,
    int32,
    uint32,
    boolean,  ///< of specialization constants only; 4 bytes, 0 or 1
    float16,
    float64,
    other,  ///< integers of another size than 4 bytes
};

/// "float", "int", "uint", "bool", "half", "double" or "another type".
std::string_view to_string(ScalarType type);
/// Returns the bytes of a number; 0 for another type.
std::size_t bytes_of(ScalarType type);

/// A number in a block, at any depth of its structures, arrays, vectors and matrices.
struct ReflectedScalar {
    std::string name;        ///< "light.direction[2]"
    std::size_t offset = 0;  ///< bytes
    ScalarType type = ScalarType::other;
};

/// The numbers of a storage buffer: a head, then elements of the block's last member if this is an array.
struct BlockScalars {
    std::uint32_t binding = 0;
    std::size_t head_bytes = 0;   ///< of the members before the array; of the whole block without one
    std::size_t stride = 0;       ///< bytes per element; 0 without an array
    std::size_t fixed_count = 0;  ///< elements that the shader declares; 0: as many as the buffer holds
    std::vector<ReflectedScalar> head;
    std::vector<ReflectedScalar> element;  ///< offsets from the start of an element
    bool complete = true;                  ///< false if there are too many numbers to list, or some of another size

    /// Returns the bytes of a buffer with one element, or with all that the shader declares.
    std::size_t min_bytes() const { return head_bytes + stride * (fixed_count > 0 ? fixed_count : 1); }
};

struct ReflectedConstant {
    std::uint32_t id = 0;
    std::string name;
    ScalarType type = ScalarType::other;
};

/// What is known of all numbers that a shader exchanges with its program.
struct ShaderScalars {
    std::vector<ReflectedScalar> push;
    std::vector<BlockScalars> blocks;          ///< of the storage buffers, by binding
    std::vector<ReflectedConstant> constants;  ///< by id
};

/// Reads the numbers of a shader that reflect() accepts. Throws ShaderError if it is not valid SPIR-V.
ShaderScalars reflect_scalars(const Shader& shader);

}  // namespace exemplar
