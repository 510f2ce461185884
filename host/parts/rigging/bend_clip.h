#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "host/animation/animation.h"

namespace exemplar {

/// Returns a clip "bend" that bends each joint but the roots in turn, by `degrees` about its x axis and back, and then
/// about its z axis, in `frames_per_bend` frames each. The first and last frame are at rest.
Clip bend_each_joint(const Rig& rig, double degrees = 30, std::size_t frames_per_bend = 8);

/// Rotations of joints in degrees about their own axes: x first, then y, then z (the matrix Rz Ry Rx).
using JointAngles = std::map<std::string, Vec3>;

/// Reads poses from JSON: an object with a list of three angles per joint, or a list of such objects. Throws DataError
/// that names the file, the joint, and what is expected.
std::vector<JointAngles> read_poses(const std::filesystem::path& path);

/// Returns a clip "pose" that moves from rest through the poses, in `frames_per_pose` frames each. Throws DataError
/// that begins with `source` for a joint that the rig does not have, and suggests the nearest name.
Clip clip_of_poses(const Rig& rig, const std::vector<JointAngles>& poses, const std::string& source,
                   std::size_t frames_per_pose = 15);

}  // namespace exemplar
