#pragma once

#include "host/core/random.h"
#include "host/synth/damage/damage.h"

namespace exemplar {

// What the table of damages is made of; one file per group, the functions in the order of the table.

/// The triangles of a mesh, each its own origin.
DamagedMesh undamaged(const TriangleMesh& mesh);
/// Takes out the faces that are not `kept` (one entry per face).
void keep_faces(DamagedMesh& damaged, const std::vector<bool>& kept);
/// Adds a face that came from face `origin` of the original.
void add_face(DamagedMesh& damaged, const Face& face, std::uint32_t origin);
/// So many different faces (or other items out of `count`) in random order: `share` of them, at least one.
std::vector<std::uint32_t> random_share(std::size_t count, double share, Random& random);
/// A uniformly distributed unit vector.
Vec3d random_direction(Random& random);

// damage_faces.cpp: faces that are missing, too many, turned, or apart.
DamagedMesh cut_holes(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh duplicate_faces(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh flip_faces(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh turn_inside_out(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh split_parts(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh unweld(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh add_fins(const TriangleMesh& mesh, std::uint64_t seed);

// damage_meshing.cpp: the same shape in other triangles.
DamagedMesh make_slivers(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh decimate(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh refine_to_4(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh refine_to_9(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh pair_to_quads(const TriangleMesh& mesh, std::uint64_t seed);

// damage_points.cpp: vertices elsewhere, or in another order.
DamagedMesh add_noise(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh add_strong_noise(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh rotate(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh scale_down(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh scale_up(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh move_far(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh add_loose_vertices(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh shuffle_order(const TriangleMesh& mesh, std::uint64_t seed);

}  // namespace exemplar
