#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "apps/viewer/controls/orbit_camera.h"
#include "apps/viewer/scene/document.h"
#include "apps/viewer/scene/view_settings.h"
#include "gpu/lines/animation_renderer.h"
#include "gpu/lines/device_style.h"
#include "gpu/runtime/record/stream.h"
#include "host/curvature/model/model.h"

namespace exemplar {

/// Returns how curvature is measured: as in the training of the model, so that both can be compared; null: by the
/// defaults of training. It is never measured by robust fits, which the device does not have.
CurvatureOptions measuring_options(const CurvatureModel* model);

/// A document on the device, drawn with the viewer's settings in one view or in two side by side.
class SurfaceScene {
  public:
    /// The document must outlive this. Throws MeshError or DeviceLimitError if the device cannot show it.
    SurfaceScene(Device& device, const Document& document);

    /// Sets the model of learned curvature; null: none. Throws ModelError if it is of another surface.
    void set_model(std::shared_ptr<const CurvatureModel> model);

    /// Records a frame in one view, or in two with learned and estimated curvature.
    void record(Stream& stream, const SurfaceShape& shape, const OrbitCamera& camera,
                std::span<const VkExtent2D> extents, const ViewSettings& settings);
    /// Holds the picture of a view when the recorded work is done.
    Canvas& canvas(std::size_t view) { return renderer_->view(view).canvas(); }

  private:
    // The shape and curvature on the device. They are recorded again only if they change, not if the camera moves.
    struct Recorded {
        SurfaceShape shape;
        CurvatureSource source;
        bool cut;
    };
    static bool same(const Recorded& a, const Recorded& b);
    void find_feature_size();
    void prepare_views(std::size_t count, const ViewSettings& settings);
    LinePicture picture_of(const OrbitCamera& camera, VkExtent2D extent, const ViewSettings& settings) const;
    const Document& document_;
    Device& device_;
    std::unique_ptr<AnimationRenderer> renderer_;  // made anew for another model
    std::shared_ptr<const CurvatureModel> model_;
    std::optional<Recorded> recorded_;
    float feature_size_ = 0;  // 0: not yet found
    DeviceStyle style_;
    std::uint64_t style_version_ = 0, colors_version_ = 0;
    std::size_t colored_views_ = 0, styled_views_ = 0;  // numbers of views that have the face colors, the textures
};

}  // namespace exemplar
