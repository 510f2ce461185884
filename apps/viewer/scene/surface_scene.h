#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "apps/viewer/controls/orbit_camera.h"
#include "apps/viewer/scene/document.h"
#include "apps/viewer/scene/scene_view.h"
#include "apps/viewer/scene/view_settings.h"
#include "gpu/curvature/animated_surface.h"
#include "gpu/runtime/record/stream.h"
#include "host/curvature/model/model.h"

namespace exemplar {

/// Shape of a surface at one frame: a pose of its rig, or vertices of a sequence.
struct FrameShape {
    std::optional<Pose> pose;
    std::span<const Vec3> vertices{};  ///< empty for rigs
};

/// Returns the shape at a frame of a document. The document must outlive it.
FrameShape frame_shape_of(const Document& document, std::size_t clip, std::size_t frame);
/// Computes the vertices of a shape, on the host.
std::vector<Vec3> vertices_at(const Document& document, const FrameShape& moment);

/// A document on the device. Computes vertices, normals, curvature and pictures from a pose there, without copying
/// any of them to the host.
class SurfaceScene {
  public:
    /// The document must outlive this. Throws MeshError or DeviceLimitError if the device cannot show it.
    SurfaceScene(Device& device, const Document& document);

    /// Sets the model of learned curvature; null: none. Throws ModelError if it is of another surface.
    void set_model(std::shared_ptr<const CurvatureModel> model);
    bool has_model() const { return model_ != nullptr; }

    /// Records a frame in one view, or in two side by side with learned and estimated curvature.
    void record(Stream& stream, const FrameShape& moment, const OrbitCamera& camera,
                std::span<const VkExtent2D> extents, const ViewSettings& settings);
    SceneView& view(std::size_t index) { return views_[index]; }

  private:
    void record_moment(Stream& stream, const FrameShape& moment, CurvatureSource source);
    void find_feature_size();
    const Document& document_;
    GpuSurface surface_;
    GpuLineSurface line_surface_;
    std::shared_ptr<const CurvatureModel> model_;
    std::optional<GpuAnimatedSurface> animated_;
    float feature_size_ = 0;       // 0: not yet found
    std::deque<SceneView> views_;  // as many as have been shown side by side
};

}  // namespace exemplar
