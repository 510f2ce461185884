#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/animation/animation.h"

namespace exemplar {

/// The parts of a surface that move nearly rigidly, and how to read their rotation from a pose (thesis Sec. 5.3.1).
struct Segments {
    std::vector<std::uint32_t> segment_of_vertex;
    /// Of a rig: the mean influences of each segment's vertices (compressed rows, by rising bone).
    std::vector<std::uint32_t> influence_begin;
    std::vector<Influence> influences;
    /// Of a mesh sequence: three patches of vertices per segment; their centers make a triangle whose axes are those of
    /// the segment: along its first edge, in its plane, and upright.
    struct Triangle {
        static constexpr std::size_t k_patch = 8;
        std::array<std::array<std::uint32_t, k_patch>, 3> patches;
    };
    std::vector<Triangle> triangles;

    std::size_t count() const { return influence_begin.empty() ? triangles.size() : influence_begin.size() - 1; }

    /// Rotation of each segment: from its coordinates to the world. Of a rig, from bone_transforms of the pose.
    void rotations_of_rig(std::span<const Affine> bones, std::vector<Eigen::Matrix3f>& out) const;
    void rotations_of_sequence(std::span<const Vec3> vertices, std::vector<Eigen::Matrix3f>& out) const;
};

/// Segments of a rig by mean-shift clustering of the skinning weights.
Segments segment_rig(const Rig& rig, std::size_t vertex_count);
/// Segments of a sequence: mean-shift clustering of the rotations of the vertices' neighborhoods over the given frames
/// (after James and Twigg 2005).
Segments segment_sequence(const TriangleMesh& rest, std::span<const std::vector<Vec3>> frames);

/// Segments that are given: of each vertex the number of its own, without gaps.
Segments segment_patches(const TriangleMesh& rest, const std::vector<std::uint32_t>& patch_of_vertex);

/// The rotation nearest to `linear` (its polar part), by Newton's iteration; the identity if it is singular.
Eigen::Matrix3f nearest_rotation(const Eigen::Matrix3f& linear);

}  // namespace exemplar
