#pragma once

#include <array>
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
/// begin(), record(), then commands that bring it to a window, then submit(). While the device draws it, the host
/// records the next one.
class FrameRenderer {
  public:
    explicit FrameRenderer(Device& device);
    /// Waits for all frames in flight.
    ~FrameRenderer();
    FrameRenderer(const FrameRenderer&) = delete;
    FrameRenderer& operator=(const FrameRenderer&) = delete;

    /// Begins a frame: waits until only one is in flight, and adds the times of those that are done.
    void begin(FrameTimes& times);
    /// Uploads document and model if they have changed. Throws an Error if the document cannot be shown, which must
    /// then be closed, or ModelError if the model does not fit the document.
    void follow(ViewerState& state);
    /// Records a frame of that size, in one picture or two side by side.
    void record(const ViewerState& state, ViewSize size);
    /// Records copies of the pictures to a part of an image, whose size may differ if it has just changed.
    void blit(VkImage target, VkRect2D part);
    /// Submits the frame, and returns at once.
    void submit(const SubmitOrder& order = {}) { stream().submit(order); }
    /// Waits for all frames in flight and adds their times.
    void finish(FrameTimes& times);
    /// Reads back the last frame, as RGB.
    Image read();

    /// Returns the faces of the document that a view of that size shows. Drawn only when the view has changed. Throws
    /// UsageError without a document.
    const FacePicture& face_picture(const ViewerState& state, ViewSize size);

    /// The stream of the frame.
    Stream& stream() { return turns_[turn_].stream; }
    Device& device() { return device_; }

  private:
    // The resources of one frame in flight.
    struct Turn {
        explicit Turn(Device& device) : stream(device, &profiler) {}
        Profiler profiler;
        Stream stream;
    };
    void record_empty(const ViewerState& state, VkExtent2D extent);
    void collect(Turn& turn, FrameTimes& times);
    void wait();
    Device& device_;
    std::array<Turn, 2> turns_;
    std::size_t turn_ = 0;
    std::vector<VkExtent2D> extents_;  // of the pictures of the last frame
    Canvas empty_;                     // shown without a document
    std::vector<Canvas*> shown_;       // side by side
    std::unique_ptr<SurfaceScene> scene_;
    std::uint64_t document_version_ = 0, model_version_ = 0;
    std::optional<GpuGBufferRenderer> face_renderer_;  // made for the first stroke
    FacePicture face_picture_;
    std::uint64_t face_picture_version_ = 0;  // of the document
};

}  // namespace exemplar
