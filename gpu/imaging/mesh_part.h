#pragma once

#include <span>
#include <vector>

#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A mesh as it is drawn: with a color per face, and a normal per vertex or per face; or without them.
struct MeshSurface {
    std::span<const Face> faces;
    std::span<const Vec3> vertices;
    std::span<const Vec3> normals;
    std::span<const Color> colors;
    bool vertex_normals = false;  ///< there is a normal per vertex
};

/// Some faces of a surface with only the vertices they use.
struct MeshPart {
    std::vector<Face> faces;
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;
    std::vector<Color> colors;

    MeshSurface surface(bool vertex_normals) const { return {faces, vertices, normals, colors, vertex_normals}; }
};

/// Faces [first, first + count) of the surface, in their order.
MeshPart cut_part(const MeshSurface& surface, std::size_t first, std::size_t count);

/// The most faces of which no buffer (corners, positions, normals, colors) is over `bytes`, whatever vertices they use;
/// at least one.
std::size_t faces_per_part(std::size_t bytes);

/// Whether no buffer of the whole surface is over `bytes`.
bool fits(const MeshSurface& surface, std::size_t bytes);

}  // namespace exemplar
