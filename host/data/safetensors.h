#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/core/half.h"

namespace exemplar {

/// One named array of a safetensors file, row-major, little-endian.
struct Tensor {
    std::string type;                     ///< "F32", "F16", "U8", "U16", "U32", "U64", "I8" or "I32"
    std::vector<std::size_t> shape;       ///< product = number of elements
    std::span<const std::uint8_t> bytes;  ///< elements x element size
    std::shared_ptr<const void> owner;    ///< keeps `bytes` alive: all arrays of a file that was read share its
                                          ///< content
};

/// The content of a safetensors file: text metadata and named arrays, both sorted by name, so that equal content
/// gives equal bytes.
struct TensorFile {
    std::map<std::string, std::string> metadata;
    std::map<std::string, Tensor> tensors;

    /// Adds an array; T is float, Half, std::int8_t, std::int32_t or std::uint8_t to std::uint64_t. The product of
    /// `shape` equals values.size().
    template <typename T>
    void add(const std::string& name, std::vector<std::size_t> shape, std::span<const T> values);
    template <typename T>
    void add(const std::string& name, std::vector<std::size_t> shape, const std::vector<T>& values) {
        add<T>(name, std::move(shape), std::span<const T>(values));
    }
    /// Returns a copy of an array; throws ModelError if it is missing, has another type or does not match `shape`,
    /// if that is given (k_any matches every extent). Reserves memory for `room` more elements.
    template <typename T>
    std::vector<T> get(const std::string& name, const std::vector<std::size_t>& shape = {}, std::size_t room = 0) const;
    /// Returns a metadata value; throws ModelError if it is missing.
    const std::string& meta(const std::string& key) const;

    static constexpr std::size_t k_any = static_cast<std::size_t>(-1);
    std::string path;  ///< the file that it was read from, for messages
};

/// Writes a file atomically; throws DataError.
void write_safetensors(const std::filesystem::path& path, const TensorFile& file);
/// Reads and checks the whole file: header within bounds, known types, offsets that tile the data without gaps, shapes
/// that match. Throws ModelError naming the path and what is wrong.
TensorFile read_safetensors(const std::filesystem::path& path);
/// Reads the same without copying the file; only for files that are replaced and never rewritten (see view_file).
TensorFile map_safetensors(const std::filesystem::path& path);

}  // namespace exemplar
