#pragma once

#include <cstdint>
#include <vector>

#include "host/animation/animation.h"

namespace exemplar {

/// What sliders change of the poses of a rig: nodes are turned further, blend weights are added to.
class PoseControls {
  public:
    PoseControls() = default;
    explicit PoseControls(const Rig& rig);

    /// Degrees about the x, y and z axis of a node, in this order, after the rotation that the pose has.
    std::vector<Vec3> turns;
    /// Added to the weights of the pose.
    std::vector<float> added_weights;

    bool changed() const;
    void reset();
    /// Throws UsageError if the pose is not of the rig.
    Pose apply(const Pose& pose) const;
};

/// The nodes that move something when they turn: those of bones with influence, and what these hang from; rising.
std::vector<std::uint32_t> moving_nodes(const Rig& rig);

}  // namespace exemplar
