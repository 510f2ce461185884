#pragma once

#include "host/animation/animation.h"

namespace exemplar::animation_io {

/// Welds vertices of `rest` that can never separate: rest positions and morph offsets are equal to the last bit, and
/// weights differ by at most one step of eight bits. Fills vertex_of_source. Vertices stay in order of their first
/// occurrence, whose weights are kept.
void weld_rig(Animation& animation);

/// Groups the vertices of a surface that coincide in all `shapes` (vertex positions; at least one). Returns the
/// group number of each vertex; groups are numbered in order of first vertex.
std::vector<std::uint32_t> group_inseparable(const std::vector<const std::vector<Vec3>*>& shapes);

/// Returns the first element of each group of `groups` (see group_inseparable).
template <typename T>
std::vector<T> first_of_groups(const std::vector<T>& values, const std::vector<std::uint32_t>& groups) {
    std::vector<T> kept;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (groups[i] == kept.size()) kept.push_back(values[i]);
    return kept;
}

/// Replaces vertices by groups in the faces.
void weld_faces(std::vector<Face>& faces, const std::vector<std::uint32_t>& groups);

/// Welds vertices that coincide in the rest shape and in all `shapes` (vertex positions). Fills vertex_of_source.
void weld_shapes(Animation& animation, std::vector<std::vector<Vec3>>& shapes);

}  // namespace exemplar::animation_io
