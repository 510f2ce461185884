#include "apps/viewer/frame_renderer.h"

#include <algorithm>

#include "gpu/runtime/errors.h"

namespace exemplar {
namespace {

std::array<float, 4> color_of(const Color& color) {
    return {static_cast<float>(color[0]) / 255, static_cast<float>(color[1]) / 255, static_cast<float>(color[2]) / 255,
            1};
}

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
    scene_->record(stream_, state.moment(), state.camera, extents, state.settings);
    for (std::size_t i = 0; i < parts; ++i) shown_.push_back({scene_->view(i).image(), scene_->view(i).extent()});
}

void FrameRenderer::record_empty(const ViewerState& state, VkExtent2D extent) {
    empty_.resize(extent);
    empty_.begin(stream_);
    PassTarget target = empty_.target();
    target.clear_color = color_of(state.settings.background);
    target.clear_depth = 1.0f;
    stream_.render(Pass("surface", target));
    empty_.end(stream_);
    shown_.push_back({empty_.image(), extent});
}

void FrameRenderer::blit(VkImage target, VkRect2D part) {
    std::int32_t left = part.offset.x;
    for (std::size_t i = 0; i < shown_.size(); ++i) {
        const VkExtent2D extent =
            part_of({static_cast<int>(part.extent.width), static_cast<int>(part.extent.height)}, shown_.size(), i);
        stream_.blit(shown_[i].image, shown_[i].extent, target, {{left, part.offset.y}, extent});
        left += static_cast<std::int32_t>(extent.width);
    }
}

void FrameRenderer::finish(FrameTimes& times) {
    stream_.wait();
    times.begin_frame();
    for (const auto& [kernel, entry] : profiler_.entries()) times.add(kernel, entry.milliseconds);
    profiler_.reset();
}

Image FrameRenderer::read() {
    std::vector<Image> parts;
    for (const Shown& shown : shown_) parts.push_back(read_picture(shown));
    if (parts.empty()) throw UsageError("there is no frame to read; record one first");
    if (parts.size() == 1) return std::move(parts.front());
    Image image(parts[0].width + parts[1].width, parts[0].height, 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < parts[0].width; ++x) std::ranges::copy(parts[0].pixel(x, y), image.pixel(x, y).begin());
        for (int x = 0; x < parts[1].width; ++x)
            std::ranges::copy(parts[1].pixel(x, y), image.pixel(parts[0].width + x, y).begin());
    }
    return image;
}

Image FrameRenderer::read_picture(const Shown& shown) {
    const VkExtent2D extent = shown.extent;
    std::vector<std::uint32_t> texels(std::size_t{extent.width} * extent.height);
    const Buffer buffer(device_, texels.size() * sizeof(std::uint32_t));
    stream_.copy_image(shown.image, VK_IMAGE_ASPECT_COLOR_BIT, extent, sizeof(std::uint32_t), buffer);
    stream_.fetch<std::uint32_t>(buffer, texels);
    profiler_.reset();
    Image image(static_cast<int>(extent.width), static_cast<int>(extent.height), 3);
    for (std::size_t i = 0; i < texels.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) image.data[3 * i + c] = static_cast<std::uint8_t>(texels[i] >> (8 * c));
    return image;
}

}  // namespace exemplar
