#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "host/core/parallel.h"
#include "host/shape/prepared_mesh.h"

namespace exemplar {

using Neighborhood = std::span<const GeodesicSearch::Reached>;  ///< in order of increasing distance

/// Returns the faces within `radius` of `face`. Doubles the radius until there are `least` of them, or all of the
/// component.
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

/// Returns how many leading faces of a neighborhood lie within `radius`, but at least `least`. In that case it
/// counts all faces at the same distance, so that ties are taken or left together.
inline std::size_t count_within(Neighborhood neighborhood, float radius, std::size_t least) {
    const std::size_t needed = std::min(least, neighborhood.size());
    if (needed > 0) radius = std::max(radius, 1.0001F * neighborhood[needed - 1].distance);
    const auto end =
        std::upper_bound(neighborhood.begin(), neighborhood.end(), radius,
                         [](float r, const GeodesicSearch::Reached& reached) { return r < reached.distance; });
    return static_cast<std::size_t>(end - neighborhood.begin());
}

/// Calls body(face, neighborhood) for every face, in parallel: one search serves all families that use
/// neighborhoods.
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
