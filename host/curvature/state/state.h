#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "host/animation/animation.h"

namespace exemplar {

/// A group of inputs that belong together: a joint (three inputs), a blend shape (one), or a patch of a surface.
struct Control {
    std::string name;
    std::uint32_t first_input = 0, input_count = 0;
};

/// Rotations of joints (Sec. 5.4.1): per joint the rotation relative to its mean in training, as the vector part of its
/// unit quaternion, sin(theta / 2) times the axis. For a hinge this is the thesis' cos(theta / 2) if the angle is
/// measured as a dihedral angle, pi at rest; the vector part distinguishes both directions of bending and has no
/// gimbal lock.
struct JointState {
    std::vector<std::uint32_t> nodes;           ///< per control
    std::vector<Eigen::Quaternionf> reference;  ///< per control: mean rotation in training
};

/// Weights of blend shapes (Sec. 5.6).
struct WeightState {
    std::vector<std::uint32_t> targets;  ///< per control
};

/// An edge a-b and the third vertices of its faces; a-b-left runs around a face.
struct Hinge {
    std::uint32_t a, b, left, right;
};
/// Returns the signed bending angle of a hinge in radians: zero where flat, positive where convex.
float bend(const Hinge& hinge, std::span<const Vec3> vertices);

/// Independent components of the dihedral angles of patches of a mesh sequence (Sec. 5.5.1).
struct HingeState {
    std::vector<Hinge> hinges;
    std::vector<std::uint32_t> begin;       ///< control c has the hinges [begin[c], begin[c + 1])
    Eigen::VectorXf mean;                   ///< per hinge: mean angle in training
    std::vector<Eigen::MatrixXf> unmixing;  ///< per control: inputs x hinges
};

/// Local shape, for any animation: a linear map of the normals and heights of a patch's vertices in the frame of the
/// patch (see learn_local). It takes no angle and follows the curvature more closely. Control c is segment c.
struct LocalShapeState {
    static constexpr std::size_t k_numbers = 4;  ///< of a vertex

    std::vector<std::uint32_t> begin;   ///< the vertices of control c: [begin[c], begin[c + 1])
    std::vector<std::uint32_t> vertex;  ///< a subset of each patch and its surroundings
    std::vector<Eigen::VectorXf> mean;  ///< per control: mean local shape in training
    std::vector<Eigen::MatrixXf> map;   ///< per control: inputs x size
    float unit = 1;                     ///< mesh units that positions are divided by

    /// Returns the length of a control's local shape.
    std::size_t size(std::size_t control) const { return k_numbers * (begin[control + 1] - begin[control]); }
    /// Computes the local shape of a control, size(control) numbers: per vertex its normal in the frame of the patch,
    /// `rotation`, and its height above the mean position along the third axis, divided by the unit.
    void read(std::size_t control, std::span<const Vec3> vertices, std::span<const Vec3> normals,
              const Eigen::Matrix3f& rotation, std::span<float> shape) const;
};

/// Computes the inputs x, from which curvature is predicted, of a pose or a surface.
struct StateReader {
    std::vector<Control> controls;
    std::size_t input_count = 0;
    std::variant<HingeState, JointState, WeightState, LocalShapeState> source;  ///< what inputs are read from
    std::vector<std::uint32_t> control_of_vertex;  ///< in training on a surface: the patch of each vertex

    bool is_local() const { return std::holds_alternative<LocalShapeState>(source); }
    /// Returns whether inputs are read from a pose; otherwise from a surface.
    bool is_of_rig() const { return !is_local() && !std::holds_alternative<HingeState>(source); }
    /// Returns per control its joint's node or its blend shape; nothing if inputs are read from a surface.
    std::span<const std::uint32_t> parts_of_rig() const;

    /// Computes the inputs of a rig's pose. `x` has input_count numbers.
    void read_pose(const Pose& pose, std::span<float> x) const;
    /// Computes the inputs from a surface's vertices, unit normals and segment rotations. Normals and rotations are
    /// used for local shape only.
    void read_surface(std::span<const Vec3> vertices, std::span<const Vec3> normals,
                      std::span<const Eigen::Matrix3f> rotations, std::span<float> x) const;
};

/// Builds the reader of a rig: a control per joint that turns in `poses` (skeleton) or per blend shape that changes.
StateReader make_rig_state(const Animation& animation, std::span<const Pose* const> poses);

struct SequenceStateOptions {
    std::size_t patch_vertices = 32;  ///< maximum; 0 makes the whole surface one patch
    double share = 0.95;              ///< of the variance of a patch' angles that its inputs keep
    std::size_t max_inputs = 16;      ///< of a patch, if there are several
    std::size_t max_hinges = 3000;    ///< of a patch that are measured; evenly spaced if there are more
    std::uint64_t seed = 1;
};
/// Builds the reader of a mesh sequence: a control per patch, whose inputs are the components of its dihedral
/// angles, learned from `frames`.
StateReader make_sequence_state(const TriangleMesh& rest, std::span<const std::vector<Vec3>> frames,
                                const SequenceStateOptions& options);

/// The range of the training poses, per control. The distance of a pose is its Mahalanobis distance divided by the
/// largest one of a training pose; up to 1 is within training. Inputs from local shape need no whitening, since
/// learning makes them uncorrelated and of unit variance.
struct PoseRange {
    Eigen::VectorXf mean;                    ///< of the inputs
    std::vector<Eigen::MatrixXf> whitening;  ///< per control: inputs x inputs; none for local shape
    std::vector<float> largest;              ///< per control, over the training poses
    struct Farthest {
        std::size_t control = 0;
        float distance = 0;
    };
    /// Returns the control that is farthest from training.
    Farthest farthest(const StateReader& reader, std::span<const float> x) const;
    /// Scales the inputs of each control with a distance above 1 towards the mean, to distance 1, since polynomials
    /// extrapolate badly. Returns farthest() of the unchanged x.
    Farthest bound(const StateReader& reader, std::span<float> x) const;
    /// Prepares a state for the regression: calls bound(), except for local shape, whose linear map extrapolates
    /// well, and subtracts the mean. Returns farthest() of the unchanged x.
    Farthest prepare(const StateReader& reader, std::span<float> x) const;

  private:
    float distance(const Control& control, std::size_t index, std::span<const float> x) const;
};
/// Computes the range of training states (poses x inputs). Distances are from the mean of the first `real` rows, or
/// of all.
PoseRange make_pose_range(const StateReader& reader, const Eigen::Ref<const Eigen::MatrixXf>& states,
                          std::size_t real = static_cast<std::size_t>(-1));

}  // namespace exemplar
