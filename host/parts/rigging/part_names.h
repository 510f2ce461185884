#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/mesh/queries/axes.h"
#include "host/parts/rigging/skeleton.h"

namespace exemplar {

/// Names the joints after the labels of their parts. Parts of equal label are told apart by a mirror plane, if the
/// parts lie in pairs on both sides of one of the planes of the root's part or of the whole surface: `arm_left`,
/// `arm_right`. A part is on the side of its parent; only parts whose parents are on neither side are compared with the
/// plane, by their heads. So a hand that crosses the body keeps its side. Parts that are still alike are numbered along
/// the longest principal axis within the plane: `leg_left_1`, `leg_left_2`.
/// Left is the side where the mesh coordinate that the plane's normal is closest to is larger: +x in the frame of glTF,
/// for figures that look along +z. `swap_sides` exchanges the names. Returns the plane that was used, if any.
std::optional<SymmetryPlane> name_parts(const TriangleMesh& mesh, const PartGraph& graph,
                                        const std::vector<std::string>& labels, bool swap_sides, Skeleton& skeleton);

}  // namespace exemplar
