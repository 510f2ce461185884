#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "apps/viewer/painting/brush.h"
#include "apps/viewer/scene/surface_scene.h"
#include "apps/viewer/scene/viewer_state.h"
#include "gpu/imaging/canvas.h"
#include "gpu/imaging/gbuffer_renderer.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/image.h"

namespace exemplar {

/// Draws the frames of the viewer off the screen, the same with and without a window. A frame is one submission:
/// record(), then commands that bring it to a window, then finish().
class FrameRenderer {
  public:
    explicit FrameRenderer(Device& device);

    /// Uploads document and model if they have changed. Throws an Error if the document cannot be shown, which must
    /// then be closed, or ModelError if the model does not fit the document.
    void follow(ViewerState& state);
    /// Records a frame of that size, in one picture or two side by side.
    void record(const ViewerState& state, ViewSize size);
    /// Records copies of the pictures to a part of an image, whose size may differ if it has just changed.
    void blit(VkImage target, VkRect2D part);
    /// Waits for the submitted frame and adds its times.
    void finish(FrameTimes& times);
    /// Reads back the last frame, as RGB.
    Image read();

    /// Returns the faces of the document that a view of that size shows. Drawn only when the view has changed. Throws
    /// UsageError without a document.
    const FacePicture& face_picture(const ViewerState& state, ViewSize size);

    Stream& stream() { return stream_; }
    Device& device() { return device_; }

  private:
    void record_empty(const ViewerState& state, VkExtent2D extent);
    Device& device_;
    Profiler profiler_;
    Stream stream_;
    Canvas empty_;                // shown without a document
    std::vector<Canvas*> shown_;  // side by side
    std::unique_ptr<SurfaceScene> scene_;
    std::uint64_t document_version_ = 0, model_version_ = 0;
    std::optional<GpuGBufferRenderer> face_renderer_;  // made for the first stroke
    FacePicture face_picture_;
    std::uint64_t face_picture_version_ = 0;  // of the document
};

}  // namespace exemplar
