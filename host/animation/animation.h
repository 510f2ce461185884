#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/mesh/skin.h"
#include "host/mesh/topology.h"

namespace exemplar {

/// Transform of a node relative to its parent: scale, then rotation, then translation.
struct NodeTransform {
    Vec3 translation = Vec3::Zero();
    Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();  ///< unit
    Vec3 scale = Vec3::Ones();
    bool operator==(const NodeTransform& other) const {
        return translation == other.translation && rotation.coeffs() == other.rotation.coeffs() && scale == other.scale;
    }
};

struct RigNode {
    std::string name;
    std::uint32_t parent = k_invalid_index;  ///< smaller than the node's own index; k_invalid_index at a root
    NodeTransform rest;
};

/// How a pose deforms the surface: bones follow nodes.
struct Rig : Skin {
    std::vector<RigNode> nodes;  ///< parents before children
};

/// The animation parameters of one frame.
struct Pose {
    std::vector<NodeTransform> nodes;  ///< one per node of the rig
    std::vector<float> weights;        ///< one per morph target
    bool operator==(const Pose&) const = default;
};

/// A motion as frames at a constant rate.
struct Clip {
    std::string name;
    double frames_per_second = 30;
    std::vector<Pose> poses;                ///< of a rig; empty for a mesh sequence
    std::vector<std::vector<Vec3>> frames;  ///< vertex positions of a mesh sequence; empty for a rig

    std::size_t size() const { return poses.size() + frames.size(); }
};

enum class AnimationKind { skeleton, blend_shapes, sequence };
std::string_view name_of(AnimationKind kind);

/// A deforming surface of constant topology and its motions.
struct Animation {
    std::string name;  ///< file or folder, for messages
    AnimationKind kind = AnimationKind::sequence;
    /// One vertex per place of the surface. For a rig, the positions that skinning starts from (the bind space),
    /// which need not be a pose; for a sequence, its rest shape, else its first frame.
    TriangleMesh rest;
    /// For each vertex of the files, in their order, the vertex of `rest` that it was welded to.
    std::vector<std::uint32_t> vertex_of_source;
    Rig rig;  ///< without nodes and bones for a sequence
    std::vector<Clip> clips;
    std::vector<std::string> warnings;  ///< one line each: what was repaired or left out

    std::size_t frame_count() const;  ///< summed over all clips
    bool has_rig() const { return kind != AnimationKind::sequence; }
    /// Returns whether the surface can move: false for a mesh alone (see read_surface).
    bool moves() const { return has_rig() || frame_count() > 0; }
};

/// The shape of an animated surface at one time.
struct SurfaceShape {
    std::optional<Pose> pose;          ///< of its rig
    std::span<const Vec3> vertices{};  ///< of a surface without a rig; empty for rigs
};
/// Returns the shape at a frame, or at rest if there is no such frame. The animation must outlive it.
SurfaceShape shape_at(const Animation& animation, std::size_t clip, std::size_t frame);
/// Computes the vertices of a shape of the animation.
std::vector<Vec3> vertices_of(const Animation& animation, const SurfaceShape& shape);

/// Returns the pose in which every node and weight is at rest.
Pose rest_pose(const Rig& rig);

/// Computes the world transform of each node (product of the transforms from its root down).
std::vector<Affine> node_transforms(const Rig& rig, const Pose& pose);
/// Computes the transform of the rest mesh by each bone, world(node) * inverse_bind: the palette of linear blend
/// skinning.
std::vector<Affine> bone_transforms(const Rig& rig, const Pose& pose);

/// Computes the posed vertices: morphing, then linear blend skinning. The reference for the device's kernels.
void pose_vertices(const Rig& rig, std::span<const Vec3> rest, const Pose& pose, std::vector<Vec3>& out);

/// Returns the vertex positions of one frame of a clip. Throws UsageError if there is no such frame.
std::vector<Vec3> frame_vertices(const Animation& animation, const Clip& clip, std::size_t frame);

}  // namespace exemplar
