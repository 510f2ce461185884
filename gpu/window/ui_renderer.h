#pragma once

#include <volk.h>

#include <cstdint>
#include <vector>

#include "gpu/runtime/kernels/draw_pipeline.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "shaders/shared/window.h"

struct ImDrawData;
struct ImFontAtlas;

namespace exemplar {

/// Draws the interface that Dear ImGui has laid out over an image. The font atlas is the only supported texture.
class UiRenderer {
  public:
    /// Builds the atlas from the fonts added to it, and uploads it. `color` is the format of the images that are
    /// drawn over.
    UiRenderer(Device& device, VkFormat color, ImFontAtlas& fonts);

    /// Draws over `target`, which must be in the layout of a color attachment.
    void record(Stream& stream, const ImDrawData& interface, VkImageView target, VkExtent2D extent);

  private:
    void upload_atlas(ImFontAtlas& fonts);
    void upload_triangles(Stream& stream, const ImDrawData& interface);
    Device& device_;
    DrawPipeline pipeline_;
    shared::InterfaceParameters parameters_{};
    Buffer atlas_, indices_, vertices_;
    // Kept between frames to avoid allocations.
    std::vector<std::uint32_t> index_values_;
    std::vector<shared::InterfaceVertex> vertex_values_;
};

}  // namespace exemplar
