#pragma once

#include <cstddef>
#include <cstdint>

#include "gpu/imaging/canvas.h"
#include "gpu/imaging/mesh_part.h"
#include "gpu/imaging/picture_tile.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/draw_pipeline.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/camera.h"
#include "host/imaging/gbuffer.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A G-buffer on the device, row by row from the top left.
struct GpuGBuffer {
    int width = 0, height = 0;
    Buffer face;         ///< a uint per pixel; k_no_face: no face
    Buffer barycentric;  ///< 2 x pixels: a float per pixel for corner 1, then one for corner 2
    Buffer depth;        ///< a float per pixel; infinity: no face

    /// Waits for the work that `stream` has recorded, and returns the result.
    GBuffer fetch(Stream& stream) const;
};

/// Renders G-buffers on the device. Faces equal those of render_gbuffer except at pixels within about 1/16 pixel of
/// an edge, since devices round vertex positions, and where surfaces meet, since they round depths. Where faces
/// agree, the visible points differ by float rounding: below 1/1000 of a pixel, more where a face is nearly edge-on.
/// Reruns on one device give the same bytes. One thread at a time may use a renderer.
class GpuGBufferRenderer final : public GBufferRenderer {
  public:
    /// `tile_size` is the maximum width and height, in pixels, drawn at once. `part_bytes` bounds each of a mesh's
    /// buffers below the device's own limits; larger meshes are drawn in parts. Throws DeviceError if the device
    /// cannot draw, UsageError for tiles without pixels.
    explicit GpuGBufferRenderer(Device& device, int tile_size = 2048, std::size_t part_bytes = std::size_t{1} << 30,
                                Profiler* profiler = nullptr);

    /// Renders into device buffers. Throws UsageError if the image is empty, DeviceLimitError if it has more pixels
    /// than a kernel can access at once, or a tile is larger than the device's images can be.
    GpuGBuffer render_on_device(const TriangleMesh& mesh, const Camera& camera, int width, int height);
    /// Renders as render_on_device does, then downloads the result.
    GBuffer render(const TriangleMesh& mesh, const Camera& camera, int width, int height) override;

  private:
    struct View {
        const Camera& camera;
        int width, height;
    };
    // Some of the mesh's faces, on the device.
    struct Part {
        std::uint32_t first, end;
        Buffer positions, faces;
    };
    GpuGBuffer record(const TriangleMesh& mesh, const Camera& camera, int width, int height);
    Part upload(const MeshSurface& surface, std::size_t first);
    template <typename Use>
    void for_each_part(const MeshSurface& surface, Use&& use);
    void reserve_tile(int width, int height);
    void draw_faces(const PictureTile& tile, const View& view, const MeshSurface& surface);
    void find_points(const PictureTile& tile, const View& view, const MeshSurface& surface, const GpuGBuffer& out);

    Device& device_;
    int tile_size_;
    std::size_t part_bytes_;
    Canvas canvas_;  // face numbers, starting with 1; as large as the largest tile so far
    DrawPipeline pipeline_;
    Kernel points_;
    Stream stream_;
    Part whole_{};    // a mesh that is drawn in one part
    Buffer numbers_;  // face numbers of a tile
};

}  // namespace exemplar
