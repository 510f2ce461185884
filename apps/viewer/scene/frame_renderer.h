#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "apps/viewer/scene/surface_scene.h"
#include "apps/viewer/window/viewer_state.h"
#include "gpu/imaging/canvas.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/image.h"

namespace exemplar {

/// Draws what a viewer shows, into pictures off the screen: the same frames with and without a window. A frame is one
/// submission: record(), then whatever brings it to a window, then finish().
class FrameRenderer {
  public:
    explicit FrameRenderer(Device& device);

    /// Brings document and model to the device if they are others than before. Throws an Error if it cannot show the
    /// document, which must then be closed, or ModelError if the model is not of it.
    void follow(ViewerState& state);
    /// Records a frame of that size, in one picture or two side by side.
    void record(const ViewerState& state, ViewSize size);
    /// Records copies of the pictures to a part of an image, whose size may differ if it has just changed.
    void blit(VkImage target, VkRect2D part);
    /// Waits for the frame that was submitted; takes its times down.
    void finish(FrameTimes& times);
    /// The frame that was drawn last, read back: RGB.
    Image read();

    Stream& stream() { return stream_; }
    Device& device() { return device_; }

  private:
    void record_empty(const ViewerState& state, VkExtent2D extent);
    Device& device_;
    Profiler profiler_;
    Stream stream_;
    Canvas empty_;                // without a document
    std::vector<Canvas*> shown_;  // side by side
    std::unique_ptr<SurfaceScene> scene_;
    std::uint64_t document_version_ = 0, model_version_ = 0;
};

}  // namespace exemplar
