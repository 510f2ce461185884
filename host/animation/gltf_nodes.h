#pragma once

#include <string>
#include <vector>

#include "host/animation/animation.h"
#include "host/mesh/gltf/gltf_reader.h"

namespace exemplar::animation_io {

/// Reads the transform of node `index` relative to its parent. Decomposes a matrix; warns and drops the shear if it
/// has any.
NodeTransform read_gltf_transform(const mesh_io::GltfReader& gltf, int index, std::vector<std::string>& warnings);

/// Returns the quaternion scaled to length one; the identity if it is zero.
Eigen::Quaternionf unit_quaternion(float x, float y, float z, float w);

}  // namespace exemplar::animation_io
