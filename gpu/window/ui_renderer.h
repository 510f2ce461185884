#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/runtime/kernels/draw_pipeline.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "shaders/shared/window.h"

struct ImDrawData;
struct ImFontAtlas;

namespace exemplar {

/// Returns the texture that images in the interface name: the pictures of set_pictures(). Everything else uses the font
/// atlas.
void* picture_texture();

/// Draws the interface that Dear ImGui has laid out over an image.
class UiRenderer {
  public:
    /// Builds the atlas from the fonts added to it, and uploads it. `color` is the format of the images that are
    /// drawn over.
    UiRenderer(Device& device, VkFormat color, ImFontAtlas& fonts);

    /// Sets the pictures of picture_texture(): RGBA texels, red lowest, row by row. Throws UsageError if they are not
    /// width x height.
    void set_pictures(std::span<const std::uint32_t> texels, std::uint32_t width, std::uint32_t height);

    /// Draws over `target`, which must be in the layout of a color attachment.
    void record(Stream& stream, const ImDrawData& interface, VkImageView target, VkExtent2D extent);

  private:
    void upload_atlas(ImFontAtlas& fonts);
    void upload_triangles(Stream& stream, const ImDrawData& interface);
    Device& device_;
    DrawPipeline pipeline_;
    shared::InterfaceParameters parameters_{};
    Buffer atlas_, pictures_, indices_, vertices_;
    std::uint32_t picture_width_ = 1, picture_height_ = 1;
    // Kept between frames to avoid allocations.
    std::vector<std::uint32_t> index_values_;
    std::vector<shared::InterfaceVertex> vertex_values_;
};

}  // namespace exemplar
