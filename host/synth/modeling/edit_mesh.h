#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// An editable closed manifold triangle mesh: edge collapses and flips keep it closed and manifold.
class EditMesh {
  public:
    explicit EditMesh(const TriangleMesh& mesh);

    std::size_t vertex_count() const { return positions_.size(); }
    std::size_t live_faces() const { return live_faces_; }
    const Vec3& position(std::uint32_t v) const { return positions_[v]; }
    /// Sets a vertex's position and its reference normal. Faces must not turn away from that normal.
    void move(std::uint32_t v, const Vec3& position, const Vec3& normal);
    const Vec3& normal(std::uint32_t v) const { return normals_[v]; }
    bool is_live(std::uint32_t v) const { return !faces_of_[v].empty(); }
    std::span<const std::uint32_t> faces_of(std::uint32_t v) const { return faces_of_[v]; }
    const Face& face(std::uint32_t f) const { return faces_[f]; }
    bool is_live_face(std::uint32_t f) const { return alive_[f]; }
    std::size_t face_count() const { return faces_.size(); }  ///< including removed ones
    /// Returns the neighbors of v, each once, in an unspecified but reproducible order; valid until the next call.
    std::span<const std::uint32_t> neighbors(std::uint32_t v);
    /// Returns every undirected edge once, the smaller vertex first, sorted.
    std::vector<std::array<std::uint32_t, 2>> edges() const;

    /// Merges `gone` into `kept` at their midpoint. Returns false, without a change, if that would break the mesh or
    /// fold it over.
    bool collapse(std::uint32_t kept, std::uint32_t gone);
    /// Flips the edge a-b inside its two triangles if that increases their smallest angle; returns whether it did.
    bool improve_edge(std::uint32_t a, std::uint32_t b);
    /// Returns whether v can move to this position without folding a face.
    bool can_move(std::uint32_t v, const Vec3& position, const Vec3& normal) const;
    /// Returns the mesh without removed elements, vertices in their old order.
    TriangleMesh compact() const;

  private:
    bool is_folded(const std::array<Vec3, 3>& corners, const Vec3& reference) const;
    std::array<Vec3, 3> corners(const Face& face) const;
    bool survives_merge(std::uint32_t v, std::uint32_t other, const Vec3& position, const Vec3& normal) const;
    bool are_linked_safely(std::uint32_t a, std::uint32_t b);
    void drop_face(std::uint32_t f, std::uint32_t v);

    std::vector<Vec3> positions_, normals_;
    std::vector<Face> faces_;
    std::vector<bool> alive_;
    std::vector<std::vector<std::uint32_t>> faces_of_;
    std::vector<std::uint32_t> neighbors_, marks_;
    std::uint32_t mark_ = 0;
    std::size_t live_faces_ = 0;
};

}  // namespace exemplar
