#pragma once

#include <span>
#include <vector>

#include "host/hatching/features/spherical_harmonics.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// What a surface hides of its own surroundings, per vertex, as spherical harmonics (Sloan et al. 2002): it does not
/// depend on view or light.
struct SelfOcclusion {
    std::vector<float> ambient;         ///< V: share of an evenly bright surrounding's light that arrives, in [0, 1]
    std::vector<Harmonics> visibility;  ///< V: of the function that is 1 where the half space above is open, else 0
    std::vector<Harmonics> transfer;    ///< V: of the same times the cosine to the normal, over pi
};

/// Measures self-occlusion by about rays / 2 Embree rays per vertex. `normals`: unit, per vertex.
SelfOcclusion measure_self_occlusion(const TriangleMesh& mesh, std::span<const Vec3> normals, std::size_t rays = 512);

/// How bright each vertex is in the light of a distant source (unit direction to it): Lambertian reflectance with
/// self-occlusion, in [0, 1]; about max(0, L.N) on a convex surface.
std::vector<float> shade(const SelfOcclusion& occlusion, const Vec3& light);

/// Vector irradiance of each vertex (Arvo 1994): the mean of the directions that the light of the same source, which
/// spherical harmonics spread over the sky, arrives from, times its amount; any length.
std::vector<Vec3> vector_irradiance(const SelfOcclusion& occlusion, const Vec3& light);

}  // namespace exemplar
