#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "host/core/parallel.h"
#include "host/shape/prepared_mesh.h"

namespace exemplar {

/// The faces (or edges) around one of them.
struct Neighborhood {
    std::span<const GeodesicSearch::Reached> faces;  ///< in order of increasing distance
    float complete_distance;                         ///< all faces nearer than this are among them; may be infinite
};

/// Returns the maximum size of the neighborhoods on a mesh of `faces` faces, so that a mesh whose faces crowd in a
/// small part of it (a ball on a wide floor) costs no more than others. It is a quarter of the mesh, at least 1,024 and
/// at most 8,192: the neighborhoods of ordinary meshes are smaller.
constexpr std::size_t max_neighborhood(std::size_t faces) {
    return std::clamp<std::size_t>(faces / 4, 1024, 8192);
}

/// Returns the maximum size of the neighborhoods of `radius` on this mesh: max_neighborhood, or 1,024 if the mean of 64
/// of them exceeds an eighth of the mesh: then most faces crowd in a small part of it. That of ordinary meshes is below
/// a ninth.
std::size_t choose_max_neighborhood(const PreparedMesh& prepared, float radius);

/// Returns the faces within `radius` of `face`, nearest first, at most `max_faces`. Where more are as near as the last,
/// either all or none of those are left out, unless fewer than `least` would remain.
inline Neighborhood find_bounded_neighborhood(GeodesicSearch& search, std::uint32_t face, float radius,
                                              std::size_t least, std::size_t max_faces) {
    auto found = search.within(face, radius, max_faces);
    const float complete = search.complete_distance();
    while (found.size() > least && found.back().distance >= complete) found = found.first(found.size() - 1);
    return {found, complete};
}

/// Returns the faces within `radius` of `face`, at most `max_faces`. Doubles the radius until there are `least` of them
/// (at most `max_faces`), or all of the component.
inline Neighborhood find_neighborhood(const PreparedMesh& prepared, GeodesicSearch& search, std::uint32_t face,
                                      float radius, std::size_t least, std::size_t max_faces) {
    const std::size_t needed = std::min<std::size_t>(least, prepared.component_size[face]);
    Neighborhood found = find_bounded_neighborhood(search, face, radius, needed, max_faces);
    while (found.faces.size() < needed) {
        radius *= 2.0F;
        found = find_bounded_neighborhood(search, face, radius, needed, max_faces);
    }
    return found;
}

/// Returns how many leading faces of a neighborhood lie within `radius`, but at least `least`. In that case it
/// counts all faces at the same distance, so that ties are taken or left together.
inline std::size_t count_within(Neighborhood neighborhood, float radius, std::size_t least) {
    const auto faces = neighborhood.faces;
    const std::size_t needed = std::min(least, faces.size());
    if (needed > 0) radius = std::max(radius, 1.0001F * faces[needed - 1].distance);
    const auto end =
        std::upper_bound(faces.begin(), faces.end(), radius,
                         [](float r, const GeodesicSearch::Reached& reached) { return r < reached.distance; });
    return static_cast<std::size_t>(end - faces.begin());
}

/// Calls body(face, neighborhood) for every face, in parallel: one search serves all families that use
/// neighborhoods.
template <typename Body>
void for_each_neighborhood(const PreparedMesh& prepared, float radius, std::size_t least, Body&& body) {
    const std::size_t max_faces = choose_max_neighborhood(prepared, radius);
    parallel_ranges(prepared.face_count(), 128, [&](std::size_t begin, std::size_t end) {
        GeodesicSearch search(prepared.graph);
        for (std::size_t f = begin; f < end; ++f) {
            const auto face = static_cast<std::uint32_t>(f);
            body(face, find_neighborhood(prepared, search, face, radius, least, max_faces));
        }
    });
}

}  // namespace exemplar
