#pragma once

#include <cstdint>
#include <vector>

#include "host/animation/animation.h"

namespace exemplar {

/// Changes of a rig's poses by sliders: further rotations of nodes, and additions to blend weights.
class PoseControls {
  public:
    PoseControls() = default;
    explicit PoseControls(const Rig& rig);

    /// Degrees about the x, y and z axis of each node, in this order, after the rotation of the pose.
    std::vector<Vec3> turns;
    /// Added to the weights of the pose.
    std::vector<float> added_weights;

    bool changed() const;
    void reset();
    /// Throws UsageError if the pose is not of the rig.
    Pose apply(const Pose& pose) const;
};

/// Returns the nodes whose rotation moves vertices: those of bones with influence, and their ancestors; ascending.
std::vector<std::uint32_t> moving_nodes(const Rig& rig);

}  // namespace exemplar
