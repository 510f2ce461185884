#pragma once

#include <string>

#include "apps/import/scene.h"

namespace exemplar::import {

/// Returns the meshes at rest as a binary PLY file: positions in doubles, and the polygons of the file.
std::string still_ply(const Scene& scene);

/// Returns the scene as binary glTF: its nodes, its meshes cut into triangles, the joints of all skins as one skin,
/// morph targets and animations. Throws std::runtime_error if it is too large for the format.
std::string animated_glb(const Scene& scene);

}  // namespace exemplar::import
