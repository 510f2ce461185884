#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/animation/animation.h"

namespace exemplar {

/// The nearly rigid parts of a surface, and what their rotations in a pose are computed from (thesis Sec. 5.3.1).
struct Segments {
    std::vector<std::uint32_t> segment_of_vertex;
    /// Rigs only: mean influences of each segment's vertices (compressed rows, by ascending bone).
    std::vector<std::uint32_t> influence_begin;
    std::vector<Influence> influences;
    /// Mesh sequences only: three patches of vertices per segment. Their centers form a triangle that defines the
    /// axes of the segment: along its first edge, in its plane, and along its normal.
    struct Triangle {
        static constexpr std::size_t k_patch = 8;
        std::array<std::array<std::uint32_t, k_patch>, 3> patches;
    };
    std::vector<Triangle> triangles;

    std::size_t count() const { return influence_begin.empty() ? triangles.size() : influence_begin.size() - 1; }

    /// Computes each segment's rotation from its coordinates to the world. `bones`: bone_transforms of the pose.
    void rotations_of_rig(std::span<const Affine> bones, std::vector<Eigen::Matrix3f>& out) const;
    void rotations_of_sequence(std::span<const Vec3> vertices, std::vector<Eigen::Matrix3f>& out) const;
};

/// Computes the segments of a rig by mean-shift clustering of the skinning weights.
Segments segment_rig(const Rig& rig, std::size_t vertex_count);
/// Computes the segments of a sequence by mean-shift clustering of the rotations of the vertices' neighborhoods over
/// the given frames (after James and Twigg 2005).
Segments segment_sequence(const TriangleMesh& rest, std::span<const std::vector<Vec3>> frames);

/// Builds segments from a given segment number per vertex; the numbers have no gaps.
Segments segment_patches(const TriangleMesh& rest, const std::vector<std::uint32_t>& patch_of_vertex);

/// Returns the rotation nearest to `linear` (its polar factor) by Newton's iteration; identity if it is singular.
Eigen::Matrix3f nearest_rotation(const Eigen::Matrix3f& linear);

}  // namespace exemplar
