#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/imaging/camera.h"
#include "host/imaging/scan_conversion.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// For each pixel, row by row from the top left, the surface point that a camera sees through its center.
struct GBuffer {
    int width = 0, height = 0;
    std::vector<std::uint32_t> face;                ///< k_no_face where no face is visible
    std::vector<std::array<float, 2>> barycentric;  ///< of corners 1 and 2 (the rest is corner 0's), in [0, 1]
    std::vector<float> depth;                       ///< along the camera's axis, in mesh units; infinity where no face
                                                    ///< is visible

    std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// Renders G-buffers. Faces are visible from both sides; the nearest one counts, of equally near ones the first.
/// Barycentrics and depth belong to the point where the ray through the pixel's center meets the plane of the face.
/// If that point lies outside the face (coverage is rounded), it is moved inside. Pixels without a face have
/// barycentrics 0.
class GBufferRenderer {
  public:
    virtual ~GBufferRenderer() = default;
    /// Throws UsageError if the image is empty.
    virtual GBuffer render(const TriangleMesh& mesh, const Camera& camera, int width, int height) = 0;
};

/// Renders a G-buffer on the CPU: the readable reference of the device's renderer (gpu/imaging). The result does not
/// depend on the number of threads.
GBuffer render_gbuffer(const TriangleMesh& mesh, const Camera& camera, int width, int height);

class CpuGBufferRenderer final : public GBufferRenderer {
  public:
    GBuffer render(const TriangleMesh& mesh, const Camera& camera, int width, int height) override {
        return render_gbuffer(mesh, camera, width, height);
    }
};

/// Throws UsageError if the image is empty.
void check_gbuffer_size(int width, int height);

}  // namespace exemplar
