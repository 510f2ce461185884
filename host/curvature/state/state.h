#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/animation/animation.h"

namespace exemplar {

/// A group of inputs that belong together: a joint (three inputs), a blend shape (one), a patch of a cloth.
struct Control {
    std::string name;
    std::uint32_t first_input = 0, input_count = 0;
};

/// From a pose to the numbers x that curvature is predicted from.
///
/// Skeleton (Sec. 5.4.1): of each joint the rotation against its mean in training, as sin(theta / 2) times the axis:
/// the vector part of the unit quaternion. For a hinge this is the thesis' cos(theta / 2) with the angle counted, as a
/// dihedral angle is, from pi at rest; in that form it tells the two directions of bending apart and has no gimbal
/// lock. Blend shapes (Sec. 5.6): the weights. Mesh sequence: independent components of the dihedral angles (Sec.
/// 5.5.1), or what a linear map makes of the normals and heights of a patch's vertices in the frame of the patch (see
/// learn_local), which takes no angle and follows the curvature more closely.
struct StateReader {
    AnimationKind kind = AnimationKind::sequence;  ///< rigs are read as sequences are if by local shape
    std::vector<Control> controls;
    std::size_t input_count = 0;

    // skeleton
    std::vector<std::uint32_t> nodes;  ///< of each control
    std::vector<Eigen::Quaternionf> reference;

    // mesh sequence
    struct Hinge {
        std::uint32_t a, b, left,
            right;  ///< an edge a-b and the third vertices of its faces; a-b-left runs around a face
    };
    std::vector<Hinge> hinges;
    std::vector<std::uint32_t> hinge_begin;        ///< those of control c are [hinge_begin[c], hinge_begin[c + 1])
    Eigen::VectorXf mean_angles;                   ///< of each hinge
    std::vector<Eigen::MatrixXf> unmixing;         ///< of each control: inputs x hinges, or x local shape
    std::vector<std::uint32_t> control_of_vertex;  ///< in training: the patch of each vertex

    // any surface by local shape; then there are no hinges, and control c is segment c
    std::vector<std::uint32_t> local_begin;   ///< the vertices of control c: [local_begin[c], local_begin[c + 1])
    std::vector<std::uint32_t> local_vertex;  ///< some of a patch and of what surrounds it
    std::vector<Eigen::VectorXf> local_mean;  ///< of each control, in training: local shape
    float local_unit = 1;                     ///< mesh units that positions are divided by

    bool is_local() const { return !local_begin.empty(); }
    /// Length of the local shape of a control: four numbers per vertex.
    std::size_t local_size(std::size_t control) const {
        return k_local_numbers * (local_begin[control + 1] - local_begin[control]);
    }
    /// The local shape of a control, local_size numbers: of each vertex its normal in the frame of the patch,
    /// `rotation`, and its height over the center of all along the third axis, divided by local_unit.
    void read_local(std::size_t control, std::span<const Vec3> vertices, std::span<const Vec3> normals,
                    const Eigen::Matrix3f& rotation, std::span<float> shape) const;
    static constexpr std::size_t k_local_numbers = 4;

    /// x of a rig's pose. `x` has input_count numbers.
    void read_pose(const Pose& pose, std::span<float> x) const;
    /// x of a mesh sequence's vertices and their unit normals; `rotations` are those of the segments. Normals and
    /// rotations matter to local shape only.
    void read_surface(std::span<const Vec3> vertices, std::span<const Vec3> normals,
                      std::span<const Eigen::Matrix3f> rotations, std::span<float> x) const;

  private:
    void read_hinges(std::span<const Vec3> vertices, std::span<float> x) const;
};

/// Signed angle that a hinge is bent by, in radians: zero where flat, positive where convex.
float bend(const StateReader::Hinge& hinge, std::span<const Vec3> vertices);

/// Reader of a rig: a control per joint that turns in some of `poses` (skeleton), or per target that changes.
StateReader make_rig_state(const Animation& animation, std::span<const Pose* const> poses);

struct SequenceStateOptions {
    std::size_t patch_vertices = 32;  ///< at most; 0 makes the whole surface one patch
    double share = 0.95;              ///< of the variance of a patch' angles
    std::size_t most_inputs = 16;     ///< of a patch, if there is more than one
    std::size_t most_hinges = 3000;   ///< of a patch that are measured; evenly taken
    std::uint64_t seed = 1;
};
/// Reader of a mesh sequence: a control per patch, whose inputs are the components of its angles in `frames`.
StateReader make_sequence_state(const TriangleMesh& rest, std::span<const std::vector<Vec3>> frames,
                                const SequenceStateOptions& options);

/// How far a pose is from those a model has seen, control by control: the Mahalanobis distance over the largest that a
/// training pose has. Up to 1 is within the training poses. Inputs read from local shape are white as they are:
/// learning makes them uncorrelated and of unit variance.
struct PoseRange {
    Eigen::VectorXf mean;                    ///< of the inputs
    std::vector<Eigen::MatrixXf> whitening;  ///< of each control: inputs x inputs; none of local shape
    std::vector<float> largest;              ///< of each control, over the training poses
    struct Farthest {
        std::size_t control = 0;
        float distance = 0;
    };
    /// The control that is farthest from training.
    Farthest farthest(const StateReader& reader, std::span<const float> x) const;
    /// Pulls the inputs of controls beyond their largest distance back to it, towards the mean: polynomials that fit
    /// within run away beyond. Returns what farthest() says of x as it was.
    Farthest bound(const StateReader& reader, std::span<float> x) const;
    /// Makes of a state what components are predicted from: bound(), unless it is of local shape, whose map is linear
    /// and stays right beyond training; then less the mean. Returns what bound() returns.
    Farthest prepare(const StateReader& reader, std::span<float> x) const;

  private:
    float distance(const Control& control, std::size_t index, std::span<const float> x) const;
};
/// Of states of training (poses x inputs). Distances are from the mean of the first `real` of them, or of all.
PoseRange make_pose_range(const StateReader& reader, const Eigen::Ref<const Eigen::MatrixXf>& states,
                          std::size_t real = static_cast<std::size_t>(-1));

}  // namespace exemplar
