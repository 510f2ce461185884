#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "host/core/random.h"
#include "host/synth/animations/animations.h"
#include "host/synth/modeling/sculptor.h"

namespace exemplar {

constexpr std::size_t k_figure_joints = 19;

/// Range of a joint in degrees about the axes of its bone (see figure_axes): [0] bends the bone toward +z, [1]
/// twists it, [2] moves it away from the middle of the body. The right side has the same limits as the left.
struct JointLimits {
    std::array<float, 3> low, high;
};

struct FigureJoint {
    std::string_view name;
    std::uint32_t parent;  ///< k_invalid_index for the hips, the root
    float side;            ///< 1 left (+x), -1 right, 0 middle
    JointLimits limits;
};
/// Returns the joints of a figure, parents first, in the order of its rig's nodes and bones. At rest none is
/// rotated.
const std::array<FigureJoint, k_figure_joints>& figure_joints();

/// A person to be meshed and rigged: standing, arms half raised. Primitive.part is the joint that moves the
/// primitive.
struct FigureModel {
    ShapeModel shape;
    std::array<Vec3, k_figure_joints> joint;  ///< where the joints are
    std::array<Vec3, k_figure_joints> tip;    ///< where their bones end
};
FigureModel sculpt_figure(Random& random);

/// Returns the axes (columns) that a joint's limits refer to: y along its bone, z as near as possible to the
/// world's.
Eigen::Matrix3f figure_axes(const FigureModel& model, std::size_t joint);
/// Returns the rotation of a joint by angles in degrees within its limits: first about the second axis, then about
/// the first, then about the third.
Eigen::Quaternionf joint_rotation(const FigureJoint& joint, const Eigen::Matrix3f& axes,
                                  const std::array<float, 3>& degrees);
/// Returns the angles for which joint_rotation gives this rotation; the first one is in [-90, 90] degrees.
std::array<float, 3> joint_angles(const FigureJoint& joint, const Eigen::Matrix3f& axes,
                                  const Eigen::Quaternionf& rotation);

/// Makes a motion of the figure that alternates between walking and gesturing, every joint within its limits.
Clip move_figure(const FigureModel& model, const Rig& rig, std::size_t frames, Random random);

Animation make_figure(const AnimationOptions& options);

}  // namespace exemplar
