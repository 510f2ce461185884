#pragma once

#include "host/animation/animation.h"

namespace exemplar::animation_io {

/// Gives vertices of `rest` one vertex where they cannot part: equal rest positions and morph offsets to the last bit,
/// and weights that differ by no more than a step of eight bits. Fills vertex_of_source. Vertices stay in order of
/// their first place; the first one's weights stay.
void weld_rig(Animation& animation);

/// Gives vertices of a surface one vertex where all of `shapes` (vertex positions; at least one) have them at one
/// place. Returns for each the number of its group, in order of first vertex.
std::vector<std::uint32_t> group_inseparable(const std::vector<const std::vector<Vec3>*>& shapes);

/// The first element of each group of `groups` (as of group_inseparable).
template <typename T>
std::vector<T> first_of_groups(const std::vector<T>& values, const std::vector<std::uint32_t>& groups) {
    std::vector<T> kept;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (groups[i] == kept.size()) kept.push_back(values[i]);
    return kept;
}

/// Makes the faces name groups instead of vertices.
void weld_faces(std::vector<Face>& faces, const std::vector<std::uint32_t>& groups);

}  // namespace exemplar::animation_io
