#pragma once

#include "host/core/random.h"
#include "host/synth/damage/damage.h"

namespace exemplar {

// The functions in the table of damages, in its order; one file per group.

/// Returns the triangles of a mesh, each its own origin.
DamagedMesh undamaged(const TriangleMesh& mesh);
/// Removes the faces that are not `kept` (one entry per face).
void keep_faces(DamagedMesh& damaged, const std::vector<bool>& kept);
/// Adds a face that came from face `origin` of the original.
void add_face(DamagedMesh& damaged, const Face& face, std::uint32_t origin);
/// Returns distinct faces (or other items out of `count`) in random order: `share` of them, at least one.
std::vector<std::uint32_t> random_share(std::size_t count, double share, Random& random);
/// Returns a uniformly distributed unit vector.
Vec3d random_direction(Random& random);

// damage_faces.cpp: missing, duplicate, reversed or separated faces.
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

// damage_points.cpp: moved or reordered vertices.
DamagedMesh add_noise(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh add_strong_noise(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh rotate(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh scale_down(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh scale_up(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh move_far(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh add_loose_vertices(const TriangleMesh& mesh, std::uint64_t seed);
DamagedMesh shuffle_order(const TriangleMesh& mesh, std::uint64_t seed);

}  // namespace exemplar
