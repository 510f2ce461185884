#pragma once

#include <array>
#include <charconv>
#include <cstring>
#include <ostream>
#include <string>
#include <type_traits>

#include "host/mesh/mesh.h"

/// Fast, locale-free building of file contents in memory.
namespace exemplar::mesh_io {

/// Appends a number in the shortest form that reads back to the same value.
template <typename T>
void append_number(std::string& text, T value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text.append(digits.data(), end);
}

/// Appends coordinate `i` of a vertex in the file's frame: as a double if the mesh has an origin on that axis.
inline void append_coordinate(std::string& text, const TriangleMesh& mesh, const Vec3& vertex, int i) {
    if (mesh.origin[i] == 0)
        append_number(text, vertex[i]);
    else
        append_number(text, mesh.origin[i] + double{vertex[i]});
}

/// Appends the bytes of a value as they lie in memory; files are little-endian, as are the machines Exemplar runs on.
template <typename T>
void append_bytes(std::string& bytes, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    bytes.append(raw.data(), raw.size());
}

}  // namespace exemplar::mesh_io
