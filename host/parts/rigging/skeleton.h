#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/parts/rigging/part_graph.h"

namespace exemplar {

/// A joint, and the bone from it along its part.
struct Joint {
    std::string name;
    std::uint32_t part = 0;
    std::uint32_t parent = k_invalid_index;  ///< k_invalid_index at the root
    std::uint32_t boundary = 0;              ///< with the parent's part; unused at the root
    Vec3 head;                               ///< where it turns: the center of the boundary; at the root, of the part
    Vec3 tail;                               ///< the end of the bone: the next joint, or the tip of the part
    Eigen::Matrix3f axes;                    ///< columns: its axes; y along the bone, x the axis of a hinge
};

/// The skeleton of a mesh: one joint per part, parents before children.
struct Skeleton {
    std::vector<Joint> joints;
    std::vector<std::uint32_t> joint_of_part;
};

/// Returns the skeleton of a part graph (thesis Sec. 3.5): the spanning tree with the strongest boundaries, between
/// parts of different labels first, grown from `root`, or, if it is not given, from the part with the largest area. The
/// axes of the root are those of the mesh. The x axis of another joint is normal to its bone and to its parent's; where
/// these are about parallel, it is the principal axis of the surface that is most across the bone. Names are left empty
/// (see name_parts).
Skeleton build_skeleton(const TriangleMesh& mesh, const PartGraph& graph, std::optional<std::uint32_t> root = {});

}  // namespace exemplar
