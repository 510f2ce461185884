#include "apps/viewer/controls/pose_controls.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "host/core/errors.h"

namespace exemplar {
namespace {

Eigen::Quaternionf turn_of(const Vec3& degrees) {
    const Vec3 radians = degrees * (std::numbers::pi_v<float> / 180);
    return Eigen::AngleAxisf(radians.x(), Vec3::UnitX()) * Eigen::AngleAxisf(radians.y(), Vec3::UnitY()) *
           Eigen::AngleAxisf(radians.z(), Vec3::UnitZ());
}

}  // namespace

PoseControls::PoseControls(const Rig& rig)
    : turns(rig.nodes.size(), Vec3::Zero()), added_weights(rig.targets.size(), 0.0f) {}

bool PoseControls::changed() const {
    return std::ranges::any_of(turns, [](const Vec3& turn) { return !turn.isZero(0); }) ||
           std::ranges::any_of(added_weights, [](float weight) { return weight != 0; });
}

void PoseControls::reset() {
    std::ranges::fill(turns, Vec3::Zero());
    std::ranges::fill(added_weights, 0.0f);
}

Pose PoseControls::apply(const Pose& pose) const {
    if (pose.nodes.size() != turns.size() || pose.weights.size() != added_weights.size())
        throw UsageError(fmt::format("a pose of {} nodes and {} weights is not of a rig of {} and {}",
                                     pose.nodes.size(), pose.weights.size(), turns.size(), added_weights.size()));
    Pose changed = pose;
    for (std::size_t i = 0; i < turns.size(); ++i)
        if (!turns[i].isZero(0))
            changed.nodes[i].rotation = (changed.nodes[i].rotation * turn_of(turns[i])).normalized();
    for (std::size_t t = 0; t < added_weights.size(); ++t) changed.weights[t] += added_weights[t];
    return changed;
}

std::vector<std::uint32_t> moving_nodes(const Rig& rig) {
    std::vector<bool> moves(rig.nodes.size(), false);
    for (const Influence& influence : rig.influences) {
        std::uint32_t node = rig.bones[influence.bone].node;
        for (; node != k_invalid_index && !moves[node]; node = rig.nodes[node].parent) moves[node] = true;
    }
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t i = 0; i < moves.size(); ++i)
        if (moves[i]) nodes.push_back(i);
    return nodes;
}

}  // namespace exemplar
