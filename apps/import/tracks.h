#pragma once

#include <vector>

#include "apps/import/scene.h"

namespace exemplar::import {

/// Keys of one property, with linear interpolation between them (spherical for rotations): times in seconds, in
/// increasing order, and `width` numbers per key. Empty if the property does not move.
struct Track {
    std::vector<float> times;
    std::vector<float> values;
};

/// The motion of a node relative to its parent. Rotations are quaternions x, y, z, w.
struct NodeTracks {
    int node = 0;
    Track translation, rotation, scale;
};

/// Returns how an animation moves the nodes. The parts of a chain that it moves are multiplied and sampled at each of
/// their keys, and at 60 frames per second.
std::vector<NodeTracks> node_tracks(const Scene& scene, const aiAnimation& animation);

/// Returns the motion of the weights of a mesh's morph targets, one number per target and key. Empty if the animation
/// does not move them.
Track weight_track(const Scene& scene, const aiAnimation& animation, const SceneMesh& placed);

}  // namespace exemplar::import
