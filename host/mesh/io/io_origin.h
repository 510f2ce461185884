#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "host/mesh/mesh.h"

namespace exemplar::mesh_io {

/// Returns the point relative to which positions are to be stored in floats (TriangleMesh::origin): zero, unless
/// rounding to floats would move a corner by more than 1/65536 of the surface's extent on some axis, as in files with
/// geographic coordinates; then about the middle. Axes on which the surface is flat but for rounding do not count, nor
/// positions that are floats in their shortest decimal form. Only finite positions that `corners` name count.
Vec3d origin_for_floats(std::span<const Vec3d> positions, std::span<const std::uint32_t> corners);

/// Returns a warning if the position of a mesh leaves too little of the precision of its floats; else empty.
std::string far_position_warning(const TriangleMesh& mesh);

/// Returns a warning if coordinates seem to be degrees of longitude and latitude beside a height, which makes a needle
/// of every surface: if two were centered (origin_for_floats) within 180 of zero, and the mesh is a thousand times as
/// long as it is wide on both. Else empty.
std::string degrees_warning(const TriangleMesh& mesh);

}  // namespace exemplar::mesh_io
