#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/imaging/canvas.h"
#include "gpu/imaging/mesh_part.h"
#include "gpu/imaging/picture_tile.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/draw_pipeline.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/camera.h"
#include "host/imaging/image.h"
#include "host/imaging/raster.h"
#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Draws meshes with a color per face, without a window. The picture is that of render_mesh in host/imaging: the
/// same 2 x 2 samples per pixel, light and averaging in linear color. Inside surfaces they agree within 2 of 255.
/// Samples near edges may differ, since devices round vertex positions to 1/16 to 1/256 of a sample. Reruns on one
/// device give the same bytes. One thread at a time may use a renderer.
class MeshRenderer {
  public:
    /// `tile_size` is the maximum width and height, in pixels, drawn at once; it bounds the memory, not the picture.
    /// `part_bytes` bounds each of a mesh's buffers below the device's own limits; larger meshes are drawn in parts.
    /// Throws DeviceError if the device cannot draw.
    explicit MeshRenderer(Device& device, int tile_size = 1024, std::size_t part_bytes = std::size_t{1} << 30,
                          Profiler* profiler = nullptr);

    /// Returns an RGB image. `face_colors` holds one sRGB color per face. Throws UsageError if the image is empty or
    /// the number of colors is not the number of faces, DeviceLimitError if the device's images are too small for a
    /// tile.
    Image render(const TriangleMesh& mesh, std::span<const Color> face_colors, const Camera& camera, int width,
                 int height, const RenderOptions& options = {});

  private:
    // Position of a part among those drawn into a tile.
    struct PartPosition {
        bool first, last;
    };
    void upload(const MeshSurface& surface);
    void reserve_tile(int width, int height);
    void draw_parts(const PictureTile& tile, const struct MeshDraw& draw, const MeshSurface& surface);
    void draw_part(const PictureTile& tile, const struct MeshDraw& draw, PartPosition turn);
    void resolve_tile(const PictureTile& tile, Image& image);

    Device& device_;
    int tile_size_;
    std::size_t part_bytes_;
    Canvas canvas_;  // samples; as large as the largest tile so far
    DrawPipeline pipeline_;
    Kernel resolve_;
    Stream stream_;
    Buffer corners_, positions_, normals_, colors_;
    std::uint32_t corner_count_ = 0;
    // Buffers for tiles of up to this size in pixels; kept between calls.
    int tile_width_ = 0, tile_height_ = 0;
    Buffer samples_, pixels_;
    std::vector<std::uint32_t> tile_pixels_;
};

}  // namespace exemplar
