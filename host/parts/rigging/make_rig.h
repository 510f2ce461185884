#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/animation/animation.h"
#include "host/parts/rigging/part_names.h"
#include "host/parts/rigging/skeleton.h"

namespace exemplar {

/// How unlikely it is that parts of two labels belong together, by the names of the labels in alphabetical order; 1 for
/// pairs that are missing. The compatibilities of a labeling model (Eq. 3.3) are such costs: they are large for labels
/// that never touch in its training meshes.
using LabelPairCosts = std::map<std::pair<std::string, std::string>, double>;

struct RigOptions {
    std::string root{};       ///< label of the root's part; empty: the largest part
    bool swap_sides = false;  ///< exchange left and right in names
    double falloff = 0.5;     ///< reach of bends, in radii of the boundary (see weights_of_parts)
    LabelPairCosts costs{};   ///< divide the strengths of boundaries, so that a hand on a thigh is no joint
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
/// `skeleton` are filled in, and joints have no names. Of the options `root` and `costs` count.
PartRig make_skeleton(const TriangleMesh& mesh, const std::vector<std::string>& names,
                      std::span<const std::int32_t> label, const RigOptions& options = {});

}  // namespace exemplar
