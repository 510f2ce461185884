#pragma once

#include <span>
#include <vector>

#include "host/hatching/features/spherical_harmonics.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Self-occlusion per vertex, as spherical harmonics (Sloan et al. 2002); depends on neither view nor light.
struct SelfOcclusion {
    std::vector<float> ambient;         ///< V: share of a uniform environment's light that arrives, in [0, 1]
    std::vector<Harmonics> visibility;  ///< V: of the function that is 1 in open directions above the surface, else 0
    std::vector<Harmonics> transfer;    ///< V: of visibility times the cosine to the normal, over pi
};

/// Measures self-occlusion with about rays / 2 Embree rays per vertex. `normals`: unit, per vertex.
SelfOcclusion measure_self_occlusion(const TriangleMesh& mesh, std::span<const Vec3> normals, std::size_t rays = 512);

/// Returns the brightness of each vertex, in [0, 1], under a distant light (unit direction to it): Lambertian
/// reflectance with self-occlusion; about max(0, L.N) on a convex surface.
std::vector<float> shade(const SelfOcclusion& occlusion, const Vec3& light);

/// Returns the vector irradiance of each vertex (Arvo 1994): the mean direction from which light arrives, times its
/// amount; any length. The light is that of shade(), which spherical harmonics spread over the sky.
std::vector<Vec3> vector_irradiance(const SelfOcclusion& occlusion, const Vec3& light);

}  // namespace exemplar
