#pragma once

#include <volk.h>

#include <cstdint>
#include <vector>

#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/kernels/draw_pipeline.h"
#include "gpu/runtime/record/stream.h"
#include "shaders/shared/window.h"

struct ImDrawData;
struct ImFontAtlas;

namespace exemplar {

/// Draws the interface that Dear ImGui has laid out over an image. Of its textures it knows the font atlas alone.
class UiRenderer {
  public:
    /// Builds the atlas, whose fonts have been added, and puts it onto the device. `color` is the format of the images
    /// that are drawn over.
    UiRenderer(Device& device, VkFormat color, ImFontAtlas& fonts);

    /// Draws over `target`, a color attachment of that layout.
    void record(Stream& stream, const ImDrawData& interface, VkImageView target, VkExtent2D extent);

  private:
    void upload_atlas(ImFontAtlas& fonts);
    void upload_triangles(Stream& stream, const ImDrawData& interface);
    Device& device_;
    DrawPipeline pipeline_;
    shared::InterfaceParameters parameters_{};
    Buffer atlas_, indices_, vertices_;
    // Kept between frames, so that none of them allocates.
    std::vector<std::uint32_t> index_values_;
    std::vector<shared::InterfaceVertex> vertex_values_;
};

}  // namespace exemplar
