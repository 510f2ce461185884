#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Texture coordinates (u, v) of the three corners of a face.
using CornerUv = std::array<Vec2, 3>;

/// Returns texture coordinates for the faces of one part, in units of `size` (a length in mesh units):
/// - A flat part, whose thinnest principal axis has less than a fifth of the deviation of the middle one, is projected
///   onto its two longer axes.
/// - Any other part is projected onto a cylinder around its longest axis: v is the height, u the angle, scaled so that
/// the
///   texture repeats a whole number of times around it. The seam is on the side towards `center` (that of the surface),
///   so that it is on the inner side of limbs. Corners of one face never lie on both sides of the seam.
/// The axes turn with the part (see principal_axes), so the coordinates do not depend on where the shape is.
std::vector<CornerUv> project_part(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces,
                                   const Vec3& center, float size);

}  // namespace exemplar
