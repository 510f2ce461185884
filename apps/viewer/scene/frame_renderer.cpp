#include "apps/viewer/scene/frame_renderer.h"

#include <algorithm>

#include "gpu/imaging/picture.h"
#include "gpu/runtime/device/errors.h"
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

FrameRenderer::FrameRenderer(Device& device) : device_(device), stream_(device, &profiler_), empty_(device) {}

void FrameRenderer::follow(ViewerState& state) {
    if (document_version_ != state.document_version()) {
        scene_.reset();
        document_version_ = state.document_version();
        model_version_ = 0;
        state.times.clear();
        if (state.has_document()) scene_ = std::make_unique<SurfaceScene>(device_, state.document());
    }
    if (!scene_ || model_version_ == state.model_version()) return;
    model_version_ = state.model_version();
    scene_->set_model(state.model());
}

void FrameRenderer::record(const ViewerState& state, ViewSize size) {
    const std::size_t parts = scene_ && state.shows_both() ? 2 : 1;
    std::vector<VkExtent2D> extents;
    for (std::size_t i = 0; i < parts; ++i) extents.push_back(part_of(size, parts, i));
    shown_.clear();
    if (!scene_) return record_empty(state, extents.front());
    scene_->record(stream_, state.shape(), state.camera, extents, state.settings);
    for (std::size_t i = 0; i < parts; ++i) shown_.push_back(&scene_->canvas(i));
}

void FrameRenderer::record_empty(const ViewerState& state, VkExtent2D extent) {
    empty_.resize(extent);
    empty_.begin(stream_);
    stream_.render(Pass("surface", empty_.cleared(clear_value(state.settings.background))));
    empty_.end(stream_);
    shown_.push_back(&empty_);
}

void FrameRenderer::blit(VkImage target, VkRect2D part) {
    std::int32_t left = part.offset.x;
    for (std::size_t i = 0; i < shown_.size(); ++i) {
        const VkExtent2D extent =
            part_of({static_cast<int>(part.extent.width), static_cast<int>(part.extent.height)}, shown_.size(), i);
        stream_.blit(shown_[i]->image(), shown_[i]->extent(), target, {{left, part.offset.y}, extent});
        left += static_cast<std::int32_t>(extent.width);
    }
}

void FrameRenderer::finish(FrameTimes& times) {
    stream_.wait();
    times.begin_frame();
    for (const auto& [kernel, entry] : profiler_.entries()) times.add(kernel, entry.milliseconds);
    profiler_.reset();
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
    for (Canvas* canvas : shown_) canvas->record_download(stream_);
    stream_.finish();
    profiler_.reset();
    std::vector<Image> parts;
    for (const Canvas* canvas : shown_) parts.push_back(canvas->read_image());
    if (parts.empty()) throw UsageError("there is no frame to read; record one first");
    return side_by_side(parts);
}

}  // namespace exemplar
