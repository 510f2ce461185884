#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/animation/animation.h"
#include "host/parts/rigging/part_names.h"
#include "host/parts/rigging/skeleton.h"

namespace exemplar {

struct RigOptions {
    std::string root;         ///< label of the root's part; empty: the largest part
    bool swap_sides = false;  ///< exchange left and right in names
    double falloff = 0.5;     ///< reach of bends, in radii of the boundary (see weights_of_parts)
};

/// A mesh with a skeleton that was made from its parts.
struct PartRig {
    Animation animation;  ///< without clips; its rest mesh is the welded mesh, with the same faces
    PartGraph graph;
    Skeleton skeleton;
    std::optional<SymmetryPlane> mirror;  ///< that tells left from right, if any
};

/// Makes a rig of a mesh from its labels (one per triangle, indices into `names`, or -1), as in thesis Sec. 3.5. Node
/// and bone `j` of the rig are joint `j` of the skeleton. Throws UsageError if labels and mesh do not fit, DataError if
/// no part has the label of the root.
PartRig make_rig(const TriangleMesh& mesh, const std::vector<std::string>& names, std::span<const std::int32_t> label,
                 const RigOptions& options = {});

/// The skeleton alone, without weights: for comparisons. Of make_rig's result only `animation.rest`, `graph` and
/// `skeleton` are filled in, and joints have no names.
PartRig make_skeleton(const TriangleMesh& mesh, const std::vector<std::string>& names,
                      std::span<const std::int32_t> label, const std::string& root = {});

}  // namespace exemplar
