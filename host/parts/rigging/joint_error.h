#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/parts/rigging/skeleton.h"

namespace exemplar {

/// A joint of the true skeleton, and the joint of another skeleton that stands for it.
struct JointError {
    std::array<std::string, 2> labels;  ///< of the parts that it connects, in alphabetical order
    std::optional<float> distance;      ///< between the two joints, in mesh units; none if there is no such joint
};

/// A skeleton with the labels of its parts.
struct LabeledSkeleton {
    const Skeleton& skeleton;
    const PartGraph& graph;
    const std::vector<std::string>& names;
};

/// Compares two skeletons of one shape. Each true joint is paired with a joint between parts of the same two labels,
/// each with at most one: nearest pairs first. In order of the true joints, without the root.
std::vector<JointError> joint_errors(const LabeledSkeleton& truth, const LabeledSkeleton& found);

}  // namespace exemplar
