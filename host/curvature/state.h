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
/// lock. Blend shapes (Sec. 5.6): the weights. Mesh sequence (Sec. 5.5.1): independent components of the dihedral
/// angles.
struct StateReader {
    AnimationKind kind = AnimationKind::sequence;
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
    std::vector<Eigen::MatrixXf> unmixing;         ///< of each control: inputs x hinges
    std::vector<std::uint32_t> control_of_vertex;  ///< in training: the patch of each vertex

    /// x of a rig's pose. `x` has input_count numbers.
    void read_pose(const Pose& pose, std::span<float> x) const;
    /// x of a mesh sequence's vertices.
    void read_vertices(std::span<const Vec3> vertices, std::span<float> x) const;
};

/// Signed angle that a hinge is bent by, in radians: zero where flat, positive where convex.
float bend(const StateReader::Hinge& hinge, std::span<const Vec3> vertices);

/// Reader of a rig: a control per joint that turns in some of `poses` (skeleton), or per target that changes.
StateReader make_rig_state(const Animation& animation, std::span<const Pose* const> poses);

struct SequenceStateOptions {
    std::size_t patch_vertices = 64;  ///< about; 0 makes the whole surface one patch
    double share = 0.95;              ///< of the variance of a patch' angles
    std::size_t most_inputs = 12;     ///< of a patch, if there is more than one
    std::size_t most_hinges = 3000;   ///< of a patch that are measured; evenly taken
    std::uint64_t seed = 1;
};
/// Reader of a mesh sequence: a control per patch, whose inputs are the components of its angles in `frames`.
StateReader make_sequence_state(const TriangleMesh& rest, std::span<const std::vector<Vec3>> frames,
                                const SequenceStateOptions& options);

/// How far a pose is from those a model has seen, control by control: the Mahalanobis distance over the largest that a
/// training pose has. Up to 1 is within the training poses.
struct PoseRange {
    Eigen::VectorXf mean;                    ///< of the inputs
    std::vector<Eigen::MatrixXf> whitening;  ///< of each control: inputs x inputs
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
    /// Makes of a state what components are predicted from: bound() and less the mean. Returns what bound() returns.
    Farthest prepare(const StateReader& reader, std::span<float> x) const;

  private:
    float distance(const Control& control, std::size_t index, std::span<const float> x) const;
};
PoseRange make_pose_range(const StateReader& reader, const Eigen::Ref<const Eigen::MatrixXf>& states);

}  // namespace exemplar
