#include "gpu/window/ui_renderer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "embedded/window_interface_frag.h"
#include "embedded/window_interface_vert.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"

namespace exemplar {
namespace {

// Returns for each texel the opacities that are mixed between it and its neighbors; see interface.frag.
std::vector<std::uint32_t> neighborhoods(const unsigned char* alpha, int width, int height) {
    std::vector<std::uint32_t> texels;
    texels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto at = [&](int x, int y) -> std::uint32_t {
        return alpha[std::min(y, height - 1) * width + std::min(x, width - 1)];
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            texels.push_back(at(x, y) | at(x + 1, y) << 8 | at(x, y + 1) << 16 | at(x + 1, y + 1) << 24);
    return texels;
}

// Makes sure that a buffer holds `bytes`, with spare room, so that a growing interface does not reallocate every
// frame.
void make_room(Device& device, Buffer& buffer, std::size_t bytes) {
    if (buffer.bytes() < bytes) buffer = Buffer(device, std::bit_ceil(std::max<std::size_t>(bytes, 4096)));
}

// Returns the part of the image that a command may draw to; empty if it is outside.
VkRect2D scissor_of(const ImVec4& clip, const ImDrawData& interface, VkExtent2D extent) {
    const ImVec2 origin = interface.DisplayPos, scale = interface.FramebufferScale;
    const auto pixel = [](float value, std::uint32_t size) {
        return static_cast<std::int32_t>(std::clamp(value, 0.0f, static_cast<float>(size)));
    };
    const std::int32_t left = pixel((clip.x - origin.x) * scale.x, extent.width),
                       right = pixel((clip.z - origin.x) * scale.x, extent.width),
                       top = pixel((clip.y - origin.y) * scale.y, extent.height),
                       bottom = pixel((clip.w - origin.y) * scale.y, extent.height);
    return {
        {left, top},
        {static_cast<std::uint32_t>(std::max(right - left, 0)), static_cast<std::uint32_t>(std::max(bottom - top, 0))}};
}

}  // namespace

void* picture_texture() {
    static char tag;  // only its address counts
    return &tag;
}

UiRenderer::UiRenderer(Device& device, VkFormat color, ImFontAtlas& fonts)
    : device_(device),
      pipeline_(device, shaders::window_interface_vert, shaders::window_interface_frag,
                {.push_constants = layout_of<shared::InterfaceParameters>(),
                 .elements = {layout_of<std::uint32_t>(), layout_of<shared::InterfaceVertex>(),
                              layout_of<std::uint32_t>(), layout_of<std::uint32_t>()}},
                {.color = color, .blends = true}) {
    upload_atlas(fonts);
    set_pictures(std::array{std::uint32_t{0xffffffff}}, 1, 1);
}

void UiRenderer::set_pictures(std::span<const std::uint32_t> texels, std::uint32_t width, std::uint32_t height) {
    if (texels.empty() || texels.size() != std::size_t{width} * height)
        throw UsageError(fmt::format("{} texels are no picture of {} x {}", texels.size(), width, height));
    pictures_ = Buffer::of<std::uint32_t>(device_, texels);
    picture_width_ = width;
    picture_height_ = height;
}

void UiRenderer::upload_atlas(ImFontAtlas& fonts) {
    unsigned char* alpha = nullptr;
    int width = 0, height = 0;
    fonts.GetTexDataAsAlpha8(&alpha, &width, &height);
    atlas_ = Buffer::of<std::uint32_t>(device_, neighborhoods(alpha, width, height));
    parameters_.white = {fonts.TexUvWhitePixel.x, fonts.TexUvWhitePixel.y};
    parameters_.atlas_width = static_cast<std::uint32_t>(width);
    parameters_.atlas_height = static_cast<std::uint32_t>(height);
    fonts.ClearTexData();
}

void UiRenderer::upload_triangles(Stream& stream, const ImDrawData& interface) {
    index_values_.clear();
    vertex_values_.clear();
    for (int i = 0; i < interface.CmdListsCount; ++i) {
        const ImDrawList& list = *interface.CmdLists[i];
        const auto first = static_cast<std::uint32_t>(vertex_values_.size());
        for (const ImDrawIdx index : list.IdxBuffer) index_values_.push_back(first + index);
        for (const ImDrawVert& v : list.VtxBuffer) vertex_values_.push_back({v.pos.x, v.pos.y, v.uv.x, v.uv.y, v.col});
    }
    make_room(device_, indices_, index_values_.size() * sizeof(std::uint32_t));
    make_room(device_, vertices_, vertex_values_.size() * sizeof(shared::InterfaceVertex));
    stream.upload<std::uint32_t>(indices_, index_values_);
    stream.upload<shared::InterfaceVertex>(vertices_, vertex_values_);
}

void UiRenderer::record(Stream& stream, const ImDrawData& interface, VkImageView target, VkExtent2D extent) {
    if (interface.TotalIdxCount == 0 || interface.DisplaySize.x <= 0 || interface.DisplaySize.y <= 0) return;
    upload_triangles(stream, interface);
    shared::InterfaceParameters parameters = parameters_;
    parameters.scale = {2 / interface.DisplaySize.x, 2 / interface.DisplaySize.y};
    parameters.offset = {-1 - interface.DisplayPos.x * parameters.scale.x,
                         -1 - interface.DisplayPos.y * parameters.scale.y};
    Pass pass("interface", {.color = target, .depth = VK_NULL_HANDLE, .extent = extent});
    std::uint32_t first = 0;
    for (int i = 0; i < interface.CmdListsCount; ++i) {
        const ImDrawList& list = *interface.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const VkRect2D scissor = scissor_of(command.ClipRect, interface, extent);
            if (command.UserCallback || scissor.extent.width == 0 || scissor.extent.height == 0) continue;
            const bool picture = command.GetTexID() == picture_texture();
            parameters.picture_width = picture ? picture_width_ : 0;
            parameters.picture_height = picture ? picture_height_ : 0;
            pass.draw(pipeline_,
                      {.vertices = command.ElemCount, .first_vertex = first + command.IdxOffset, .scissor = scissor},
                      {indices_, vertices_, atlas_, pictures_}, parameters);
        }
        first += static_cast<std::uint32_t>(list.IdxBuffer.Size);
    }
    stream.render(pass);
}

}  // namespace exemplar
