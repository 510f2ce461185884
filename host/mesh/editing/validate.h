#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/mesh/topology.h"

namespace exemplar {

/// Defects and oddities of a mesh, and where they are.
struct MeshReport {
    std::vector<std::uint32_t> non_finite_vertices;                ///< NaN or infinity: unusable
    std::vector<std::array<std::uint32_t, 2>> non_manifold_edges;  ///< vertex pairs with more than two faces
    std::vector<std::array<std::uint32_t, 2>> inconsistent_edges;  ///< both faces traverse it in the same direction
    std::vector<std::uint32_t> degenerate_faces;                   ///< zero area or a repeated vertex
    std::vector<std::uint32_t> duplicate_faces;                    ///< same three vertices as an earlier face
    std::vector<std::uint32_t> unreferenced_vertices;
    std::size_t boundary_edges = 0;
    std::size_t components = 0;
    bool empty = false;
    bool inside_out = false;  ///< closed and consistently oriented, but the signed volume is negative

    bool usable() const { return !empty && non_finite_vertices.empty(); }
    bool clean() const;
    /// Returns one line per kind of defect: what, how many, the first few places, what Exemplar does about it.
    std::vector<std::string> messages() const;
};
MeshReport validate_mesh(const TriangleMesh& mesh);
/// Diagonals of the bounding box of a mesh that can be computed with in floats, whose range is 1e-38 to 3e38.
struct SizeRange {
    double smallest, largest;
};
constexpr SizeRange k_usable_sizes{1e-19, 1e19};    ///< whose squares are floats
constexpr SizeRange k_drawable_sizes{1e-12, 1e12};  ///< whose third powers and their inverses are: for curvature
/// Returns what is wrong with the size of a mesh, and the mend; empty if nothing is, or it has no extent.
std::string size_fault(const TriangleMesh& mesh, const SizeRange& range);
/// Throws MeshError naming `name` if the mesh is empty, not finite, or not of k_usable_sizes; returns the report
/// otherwise.
MeshReport require_usable(const TriangleMesh& mesh, const std::string& name);
/// The same for curvature, lines and hatching, which need k_drawable_sizes.
MeshReport require_drawable(const TriangleMesh& mesh, const std::string& name);

}  // namespace exemplar
