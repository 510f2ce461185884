#pragma once

#include <span>
#include <vector>

#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// The data of a mesh to draw: optionally with a color per face, and a normal per vertex or per face.
struct MeshSurface {
    std::span<const Face> faces;
    std::span<const Vec3> vertices;
    std::span<const Vec3> normals;
    std::span<const Color> colors;
    bool vertex_normals = false;  ///< normals are per vertex, else per face
};

/// Some faces of a surface with only the vertices they use.
struct MeshPart {
    std::vector<Face> faces;
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;
    std::vector<Color> colors;

    MeshSurface surface(bool vertex_normals) const { return {faces, vertices, normals, colors, vertex_normals}; }
};

/// Returns faces [first, first + count) of the surface, in their order.
MeshPart cut_part(const MeshSurface& surface, std::size_t first, std::size_t count);

/// Returns the maximum number of faces for which no buffer (corners, positions, normals, colors) exceeds `bytes`,
/// whatever vertices they use; at least one.
std::size_t faces_per_part(std::size_t bytes);

/// Returns whether no buffer of the whole surface exceeds `bytes`.
bool fits(const MeshSurface& surface, std::size_t bytes);

}  // namespace exemplar
