#pragma once

#include <cmath>
#include <numbers>

#include "host/animation/animation.h"
#include "host/core/random.h"

namespace exemplar::shapes {

/// A tube of radius 1 along x from -4 to 4 on two bones that meet in a joint at 0, with weights that change smoothly
/// over [-1, 1]; open at both ends. 2 rings x around triangles.
inline Animation tube_rig(std::uint32_t rings = 33, std::uint32_t around = 16) {
    Animation tube;
    tube.name = "tube";
    tube.kind = AnimationKind::skeleton;
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < around; ++j) {
            const double x = 8.0 * i / (rings - 1) - 4, angle = 2 * std::numbers::pi * j / around;
            tube.rest.vertices.emplace_back(float(x), float(std::cos(angle)), float(std::sin(angle)));
        }
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return i * around + j % around; };
    for (std::uint32_t i = 0; i + 1 < rings; ++i)
        for (std::uint32_t j = 0; j < around; ++j) {
            tube.rest.faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
            tube.rest.faces.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
        }
    tube.rest.source_face_count = static_cast<std::uint32_t>(tube.rest.faces.size());
    tube.rig.nodes = {{"root", k_invalid_index, {}}, {"upper", 0, {}}, {"elbow", 1, {}}};
    tube.rig.bones = {{1, Affine::Identity()}, {2, Affine::Identity()}};
    for (const Vec3& p : tube.rest.vertices) {
        const float t = std::clamp(0.5f * (p.x() + 1), 0.0f, 1.0f), weight = t * t * (3 - 2 * t);
        tube.rig.influence_begin.push_back(static_cast<std::uint32_t>(tube.rig.influences.size()));
        if (weight < 1) tube.rig.influences.push_back({0, 1 - weight});
        if (weight > 0) tube.rig.influences.push_back({1, weight});
    }
    tube.rig.influence_begin.push_back(static_cast<std::uint32_t>(tube.rig.influences.size()));
    return tube;
}

/// A clip in which the whole turns and moves as it likes and the elbow bends about z by up to `degrees`.
inline Clip bending_clip(const Animation& tube, std::size_t frames, double degrees, std::uint64_t seed) {
    Clip clip;
    clip.name = "bend " + std::to_string(seed);
    Random random(seed);
    for (std::size_t i = 0; i < frames; ++i) {
        Pose pose = rest_pose(tube.rig);
        const Vec3 axis = Vec3(float(random.normal()), float(random.normal()), float(random.normal())).normalized();
        pose.nodes[0].rotation = Eigen::AngleAxisf(float(random.uniform(-3, 3)), axis);
        pose.nodes[0].translation = Vec3(float(random.uniform(-9, 9)), 3, 0);
        const double bend = random.uniform(0, degrees) * std::numbers::pi / 180;
        pose.nodes[2].rotation = Eigen::AngleAxisf(float(bend), Vec3::UnitZ());
        clip.poses.push_back(pose);
    }
    return clip;
}

/// The tube with clips of 60 training and 20 test frames.
inline Animation bending_tube(double degrees = 40) {
    Animation tube = tube_rig();
    tube.clips = {bending_clip(tube, 60, degrees, 1), bending_clip(tube, 20, degrees, 2)};
    return tube;
}

}  // namespace exemplar::shapes
