#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gpu/runtime/kernels/reflection.h"
#include "gpu/runtime/kernels/scalars.h"

namespace exemplar {

// Parses the inputs of a shader from the command line: contents of buffers, push constants, specialization constants.

using Bytes = std::vector<std::byte>;

/// Returns a whole number that may end with K, M or G (powers of 1024). Throws UsageError naming `option`.
std::uint64_t parse_count(const std::string& option, const std::string& text);
/// Returns one to three such numbers, separated by commas; missing ones are 1.
std::array<std::uint64_t, 3> parse_box(const std::string& option, const std::string& text);

/// First contents of a binding.
struct BindingSource {
    enum class Kind { file, zeros, random, count };
    std::uint32_t binding = 0;
    Kind kind = Kind::zeros;
    std::filesystem::path path;  ///< of a file
    std::uint64_t number = 0;    ///< bytes of zeros, else values
};

/// Reads "N=FILE", "N=:BYTES" (zeros), "N=random:COUNT" (floats in [0, 1)) or "N=count:COUNT" (0, 1, 2, ... as uints).
/// Throws UsageError naming `option`.
BindingSource parse_binding(const std::string& option, const std::string& text);

/// Reads "ID=VALUE".
struct ConstantText {
    std::uint32_t id = 0;
    std::string value;
};
ConstantText parse_constant(const std::string& option, const std::string& text);

/// Returns the bytes of a raw file, or those of the array of a NumPy file (.npy). Throws DataError naming the file if
/// it cannot be read, or is a .npy of Fortran's order or of big-endian numbers.
Bytes read_values(const std::filesystem::path& path);

Bytes contents_of(const BindingSource& source);

/// Returns what a binding holds if nothing is given: as many elements as there are threads, random floats in [0, 1)
/// where the shader reads floats, else zeros.
Bytes default_contents(const ReflectedBinding& binding, const BlockScalars* scalars, std::uint64_t threads);

/// Throws UsageError, which names binding and file, if `bytes` are too few for what the shader declares, or are no
/// whole number of elements.
void check_contents(const ReflectedBinding& binding, const BlockScalars* scalars, const BindingSource& source,
                    std::size_t bytes);

/// Returns push constants of numbers separated by commas, in the order of the members. Throws UsageError, which lists
/// the members, for a wrong number of them or a number that is not of its member's type.
Bytes push_bytes(const std::string& text, const std::vector<ReflectedScalar>& members, std::size_t bytes);

/// Returns id and bits of a specialization constant. Throws UsageError, which lists those that the shader has, if it
/// has no constant of that id, or if the value is not of its type.
std::pair<std::uint32_t, std::uint32_t> constant_bits(const std::string& option, const ConstantText& constant,
                                                      const std::vector<ReflectedConstant>& constants);

/// Returns the bits of a number of a type of four bytes; nothing if it is none.
std::optional<std::uint32_t> scalar_bits(const std::string& text, ScalarType type);

}  // namespace exemplar
