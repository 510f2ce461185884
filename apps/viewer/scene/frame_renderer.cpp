#include "apps/viewer/scene/frame_renderer.h"

#include <algorithm>
#include <utility>

#include "gpu/imaging/picture.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/imaging/side_by_side.h"

namespace exemplar {
namespace {

VkExtent2D part_of(ViewSize size, std::size_t parts, std::size_t part) {
    const auto width = static_cast<std::size_t>(std::max(size.width, 1));
    const std::size_t left = part * width / parts, right = (part + 1) * width / parts;
    return {static_cast<std::uint32_t>(std::max<std::size_t>(right - left, 1)),
            static_cast<std::uint32_t>(std::max(size.height, 1))};
}

}  // namespace

FrameRenderer::FrameRenderer(Device& device) : device_(device), turns_{Turn(device), Turn(device)}, empty_(device) {}

FrameRenderer::~FrameRenderer() {
    try {
        wait();
    } catch (const DeviceError&) {
        // A lost device draws nothing to wait for.
    }
}

void FrameRenderer::begin(FrameTimes& times) {
    turn_ = 1 - turn_;
    collect(turns_[turn_], times);
}

// Waits for a frame and adds its times, if it was submitted.
void FrameRenderer::collect(Turn& turn, FrameTimes& times) {
    turn.stream.wait();
    if (turn.profiler.submissions() == 0) return;
    times.begin_frame();
    for (const auto& [kernel, entry] : turn.profiler.entries()) times.add(kernel, entry.milliseconds);
    turn.profiler.reset();
}

// Images may be replaced only while no frame uses them.
void FrameRenderer::wait() {
    for (Turn& turn : turns_) turn.stream.wait();
}

void FrameRenderer::follow(ViewerState& state) {
    if (document_version_ != state.document_version()) {
        wait();
        scene_.reset();
        document_version_ = state.document_version();
        model_version_ = 0;
        state.times.clear();
        if (state.has_document()) scene_ = std::make_unique<SurfaceScene>(device_, state.document());
    }
    if (!scene_ || model_version_ == state.model_version()) return;
    wait();
    model_version_ = state.model_version();
    scene_->set_model(state.model());
}

void FrameRenderer::record(const ViewerState& state, ViewSize size) {
    const std::size_t parts = scene_ && state.shows_both() ? 2 : 1;
    std::vector<VkExtent2D> extents;
    for (std::size_t i = 0; i < parts; ++i) extents.push_back(part_of(size, parts, i));
    const auto same = [](const VkExtent2D& a, const VkExtent2D& b) {
        return a.width == b.width && a.height == b.height;
    };
    if (!std::ranges::equal(extents_, extents, same)) wait();
    extents_ = extents;
    shown_.clear();
    if (!scene_) return record_empty(state, extents.front());
    scene_->record(stream(), state.shape(), state.camera, extents, state.settings);
    for (std::size_t i = 0; i < parts; ++i) shown_.push_back(&scene_->canvas(i));
}

void FrameRenderer::record_empty(const ViewerState& state, VkExtent2D extent) {
    empty_.resize(extent);
    empty_.begin(stream());
    stream().render(Pass("surface", empty_.cleared(clear_value(state.settings.background))));
    empty_.end(stream());
    shown_.push_back(&empty_);
}

void FrameRenderer::blit(VkImage target, VkRect2D part) {
    std::int32_t left = part.offset.x;
    for (std::size_t i = 0; i < shown_.size(); ++i) {
        const VkExtent2D extent =
            part_of({static_cast<int>(part.extent.width), static_cast<int>(part.extent.height)}, shown_.size(), i);
        stream().blit(shown_[i]->image(), shown_[i]->extent(), target, {{left, part.offset.y}, extent});
        left += static_cast<std::int32_t>(extent.width);
    }
}

void FrameRenderer::finish(FrameTimes& times) {
    for (const std::size_t turn : {1 - turn_, turn_}) collect(turns_[turn], times);
}

const FacePicture& FrameRenderer::face_picture(const ViewerState& state, ViewSize size) {
    if (!state.has_document()) throw UsageError("there is nothing to paint on; open a mesh first");
    const Camera camera = state.camera.camera(size);
    const bool same = face_picture_version_ == state.document_version() && face_picture_.width == size.width &&
                      face_picture_.height == size.height &&
                      face_picture_.camera.view_projection() == camera.view_projection();
    if (same) return face_picture_;
    if (!face_renderer_) face_renderer_.emplace(device_);
    GBuffer faces = face_renderer_->render(state.document().animation.rest, camera, size.width, size.height);
    face_picture_ = {size.width, size.height, std::move(faces.face), camera};
    face_picture_version_ = state.document_version();
    return face_picture_;
}

Image FrameRenderer::read() {
    wait();
    Stream reading(device_);
    for (Canvas* canvas : shown_) canvas->record_download(reading);
    reading.finish();
    std::vector<Image> parts;
    for (const Canvas* canvas : shown_) parts.push_back(canvas->read_image());
    if (parts.empty()) throw UsageError("there is no frame to read; record one first");
    return side_by_side(parts);
}

}  // namespace exemplar
