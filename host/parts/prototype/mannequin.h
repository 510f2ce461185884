#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/parts/prototype/print_joint.h"
#include "host/parts/prototype/print_solid.h"
#include "host/parts/rigging/make_rig.h"

namespace exemplar {

struct MannequinOptions {
    double height = 150;           ///< of the print: the longest edge of its bounding box, in mm
    double gap = 0.4;              ///< between solids that move, in mm
    std::size_t resolution = 200;  ///< cells of the grid along the longest edge
    std::string root;              ///< label of the root's part; empty: the largest
    std::vector<std::string> hinges{"lowerarm", "lower_arm", "lowerleg", "lower_leg"};  ///< labels that hang on a hinge
    LabelPairCosts costs{};                                                             ///< as in RigOptions
};

/// An articulated figure.
struct Mannequin {
    std::vector<PrintSolid> solids;  ///< named after their first joints
    std::vector<PrintJoint> joints;  ///< one per joint of the skeleton but the root, in its order, in mm
    Skeleton skeleton;               ///< in mm
    float cell = 0;                  ///< of the grid, in mm
};

/// Makes a mannequin of a closed mesh with a label per triangle (thesis Sec. 3.5, Fig. 3.9i-k). Solids are divided
/// halfway between the surfaces of parts, with a gap. Each joint of the skeleton becomes a ball, or a hinge by the
/// label of the child, whose socket in the parent holds more than half of it. The ball is as large as the parent and
/// its other joints allow, at most 0.6 of the boundary's radius. Where no ball of two gaps fits, the two parts are one
/// solid (`fused`). Throws MeshError if the mesh is not closed or a solid vanishes, UsageError for a wrong number of
/// labels.
Mannequin make_mannequin(const TriangleMesh& mesh, const std::vector<std::string>& names,
                         std::span<const std::int32_t> label, const MannequinOptions& options = {});

}  // namespace exemplar
