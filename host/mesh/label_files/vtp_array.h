#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar::label_files {

/// How a VTK XML file stores arrays: attributes of its VTKFile element.
struct VtkEncoding {
    std::size_t header_bytes = 4;  ///< of the lengths before data: UInt32 or UInt64
    bool is_compressed = false;    ///< by zlib, in blocks
    std::string_view appended{};   ///< behind the _ of AppendedData
    bool appended_is_raw = false;  ///< else base64
};

/// A DataArray element.
struct VtkArray {
    std::string name, type;    ///< such as Int32
    std::string format;        ///< ascii, binary (base64 in the element), or appended
    std::uint64_t offset = 0;  ///< in the appended data
    std::string text;          ///< content of the element
};

/// Returns the numbers of an array of `count` values, of one component. Values of floats must be integers. Decodes no
/// more than the array needs. Throws DataError that begins with `name` for anything malformed.
std::vector<std::int64_t> vtk_integers(const VtkArray& array, const VtkEncoding& encoding, std::size_t count,
                                       const std::string& name);

}  // namespace exemplar::label_files
