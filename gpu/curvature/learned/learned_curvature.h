#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gpu/curvature/learned/component_predictor.h"
#include "gpu/curvature/learned/local_state.h"
#include "gpu/curvature/learned/reprojection.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/animation/animation.h"
#include "host/curvature/model/model.h"

namespace exemplar {

/// Evaluates learned curvature (thesis Ch. 5) on the device, as CurvatureEvaluator does. Per frame only the state of
/// the pose is uploaded, 4 bytes per input and, for principal attributes, 48 per segment. Curvature stays on the
/// device, in the layout of GpuCurvature.
class GpuLearnedCurvature {
  public:
    /// The model need not outlive this. Throws ModelError if it is inconsistent, DeviceLimitError if it is too large
    /// for the device.
    GpuLearnedCurvature(Device& device, const CurvatureModel& model, const ReprojectionOptions& options = {});

    /// The surface in one frame. Models of local shape read its state from the buffers alone, models of a rig from the
    /// pose, and models of dihedral angles from the vertices on the host.
    struct Frame {
        const Buffer &vertices, &normals;  ///< as of GpuPoser and GpuNormals
        const Rig* rig = nullptr;          ///< with `pose`
        const Pose* pose = nullptr;
        std::span<const Vec3> host_vertices{};  ///< equal to `vertices`
    };
    /// Records the curvature in a frame: three dispatches, up to five for local shape, more where the device's limits
    /// are low. Throws UsageError if the frame lacks what the model reads, or does not match the model.
    void record(Stream& stream, const Frame& frame);

    /// Returns the control that was farthest from the training poses in the last call; zero for local shape, which
    /// the host does not read.
    PoseRange::Farthest farthest() const { return farthest_; }

    /// A vec4 per vertex: unit principal direction e1 and its curvature k1 >= k2, in 1 / mesh units.
    const Buffer& first() const { return reprojection_.first(); }
    /// The same for e2 and k2; e1 x e2 is the normal.
    const Buffer& second() const { return reprojection_.second(); }
    /// C111, C112, C122, C222 in (e1, e2), in 1 / squared mesh units.
    const Buffer& derivative() const { return reprojection_.derivative(); }

  private:
    void check_buffers(const Frame& frame) const;
    void read_pose(const Frame& frame);
    void read_vertices(const Frame& frame);
    void write_state(std::span<std::byte> memory) const;
    std::size_t vertex_count_;
    StateReader reader_;
    PoseRange range_;
    Segments segments_;                             // none for tensors
    std::size_t min_bones_ = 0, min_controls_ = 0;  // minimum sizes of a rig; controls: nodes or targets
    GpuComponentPredictor predictor_;
    bool is_identity_;
    GpuReprojection reprojection_;
    std::optional<GpuLocalState> local_;
    Buffer state_;  // rotations, then inputs; not of local shape
    PoseRange::Farthest farthest_;
    std::vector<float> x_;
    std::vector<Eigen::Matrix3f> rotations_;
};

}  // namespace exemplar
