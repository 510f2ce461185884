#pragma once

#include <volk.h>

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/imaging/attachment.h"
#include "gpu/imaging/draw_commands.h"
#include "gpu/imaging/mesh_pipeline.h"
#include "gpu/runtime/buffer.h"
#include "gpu/runtime/device.h"
#include "gpu/runtime/kernel.h"
#include "gpu/runtime/stream.h"
#include "host/imaging/camera.h"
#include "host/imaging/image.h"
#include "host/imaging/raster.h"
#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Draws meshes with a color per face, without a window. The picture is render_mesh's of host/imaging: the same 2 x 2
/// samples per pixel, light and averaging in linear color. Inside surfaces they agree within 2 of 255; samples near
/// edges may fall to the other side, for devices round vertex positions to 1/16 to 1/256 of a sample. Reruns on one
/// device give the same bytes. One thread at a time may use a renderer.
class MeshRenderer {
  public:
    /// `tile_size` is the largest width and height, in pixels, that is drawn at once; it bounds the memory, not the
    /// picture. Throws DeviceError if the device cannot draw, DeviceLimitError if its images are too small for a tile.
    explicit MeshRenderer(Device& device, int tile_size = 1024);

    /// An RGB image. `face_colors` holds one sRGB color per face. Throws UsageError if the image is empty or the number
    /// of colors is not the number of faces, DeviceLimitError if the mesh is over the device's limits.
    Image render(const TriangleMesh& mesh, std::span<const Color> face_colors, const Camera& camera, int width,
                 int height, const RenderOptions& options = {});

  private:
    struct Tile {
        int x, y;           // of its upper left pixel
        int width, height;  // pixels
    };
    void upload(const TriangleMesh& mesh, std::span<const Color> face_colors, const RenderOptions& options);
    void reserve_tile(int width, int height);
    void draw(VkCommandBuffer commands, const Tile& tile, const struct MeshDraw& draw) const;
    void render_tile(const Tile& tile, const struct MeshDraw& draw, Image& image);

    Device& device_;
    int tile_size_;
    VkFormat depth_format_;
    MeshPipeline pipeline_;
    Kernel resolve_;
    DrawCommands commands_;
    Stream stream_;
    Buffer corners_, positions_, normals_, colors_;
    // For tiles of up to this many pixels a side; kept between calls.
    int tile_width_ = 0, tile_height_ = 0;
    Attachment color_, depth_;
    Buffer samples_, pixels_;
    std::vector<std::uint32_t> tile_pixels_;
};

}  // namespace exemplar
