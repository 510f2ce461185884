#pragma once

#include <string>
#include <string_view>

namespace exemplar::fuzz {

/// A .glb file of one mesh whose geometry is a Draco stream: so that a fuzzer damages the stream, and not the JSON
/// around it. `content` is the number of vertices and of triangles (two bytes each, lowest first), then the stream.
std::string glb_of_draco(std::string_view content);

/// A .glb file of one mesh whose positions and indices are packed by EXT_meshopt_compression. `content` is
/// one byte each: the number of vertices; of triangles; the length of the packed positions; how the streams are packed
/// (bits 0 and 1: filter none, EXPONENTIAL, OCTAHEDRAL or QUATERNION; bit 2: INDICES instead of TRIANGLES; bit 3:
/// indices of four bytes). Then the packed positions, and the packed indices to the end.
std::string glb_of_meshopt(std::string_view content);

}  // namespace exemplar::fuzz
