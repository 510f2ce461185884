#pragma once

namespace exemplar {

// The marks of a sheet, millimeters: rings, three of them with a dot. Rings around dots are rare in drawings, and they
// are seen in perspective and under any light.
constexpr double k_mark_radius = 4, k_mark_hole = 2.6, k_mark_dot = 1.3;

}  // namespace exemplar
