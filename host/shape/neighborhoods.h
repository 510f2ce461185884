#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "host/core/parallel.h"
#include "host/shape/prepared_mesh.h"

namespace exemplar {

using Neighborhood = std::span<const GeodesicSearch::Reached>;  ///< in order of increasing distance

/// Faces within `radius` of `face`; at least `least` of them where the component has so many.
inline Neighborhood find_neighborhood(const PreparedMesh& prepared, GeodesicSearch& search, std::uint32_t face,
                                      float radius, std::size_t least) {
    const std::size_t needed = std::min<std::size_t>(least, prepared.component_size[face]);
    Neighborhood found = search.within(face, radius);
    while (found.size() < needed) {
        radius *= 2.0F;
        found = search.within(face, radius);
    }
    return found;
}

/// Number of leading faces of a neighborhood that lie within `radius`; at least `least`, and then all at that distance,
/// so that faces at equal distance are taken or left together.
inline std::size_t count_within(Neighborhood neighborhood, float radius, std::size_t least) {
    const std::size_t needed = std::min(least, neighborhood.size());
    if (needed > 0) radius = std::max(radius, 1.0001F * neighborhood[needed - 1].distance);
    const auto end =
        std::upper_bound(neighborhood.begin(), neighborhood.end(), radius,
                         [](float r, const GeodesicSearch::Reached& reached) { return r < reached.distance; });
    return static_cast<std::size_t>(end - neighborhood.begin());
}

/// Calls body(face, neighborhood) for every face, in parallel: one search serves all families that look around a face.
template <typename Body>
void for_each_neighborhood(const PreparedMesh& prepared, float radius, std::size_t least, Body&& body) {
    parallel_ranges(prepared.face_count(), 128, [&](std::size_t begin, std::size_t end) {
        GeodesicSearch search(prepared.graph);
        for (std::size_t f = begin; f < end; ++f) {
            const auto face = static_cast<std::uint32_t>(f);
            body(face, find_neighborhood(prepared, search, face, radius, least));
        }
    });
}

}  // namespace exemplar
