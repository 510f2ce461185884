#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar::mesh_io {

enum class PlyScalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
std::size_t byte_size(PlyScalar type);
inline bool is_integer(PlyScalar type) {
    return type < PlyScalar::float32;
}

struct PlyProperty {
    std::string name, shown;              ///< `shown` is printable, for messages
    PlyScalar type;                       ///< type of the value, or of each item of a list
    std::optional<PlyScalar> count_type;  ///< type of a list's item count; absent for a single value
};

struct PlyElement {
    std::string name, shown;  ///< `shown` is printable, for messages
    std::uint64_t count;
    std::vector<PlyProperty> properties;
};

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    std::map<std::int64_t, std::string> label_names;  ///< from `comment label INDEX NAME` lines
    std::size_t bytes = 0, lines = 0;                 ///< length of the header
};

/// Reads a header through its `end_header` line; throws MeshError with the line where it is malformed.
PlyHeader read_ply_header(std::string_view content, const std::string& name);

}  // namespace exemplar::mesh_io
