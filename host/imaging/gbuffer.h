#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/imaging/camera.h"
#include "host/imaging/scan_conversion.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// What a camera sees of a mesh through the center of each pixel, row by row from the top left.
struct GBuffer {
    int width = 0, height = 0;
    std::vector<std::uint32_t> face;                ///< k_no_face: nothing
    std::vector<std::array<float, 2>> barycentric;  ///< of corners 1 and 2 (the rest is corner 0's), in [0, 1]
    std::vector<float> depth;                       ///< along the camera's axis, mesh units; infinity: nothing

    std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// Renders G-buffers. Faces are seen from both sides; the nearest counts, of equally near ones the first. Barycentrics
/// and depth are those of the point where the ray through the pixel's center meets the plane of the face, moved into
/// the face where coverage was rounded in its favor; where there is no face, barycentrics are 0.
class GBufferRenderer {
  public:
    virtual ~GBufferRenderer() = default;
    /// Throws UsageError if the image is empty.
    virtual GBuffer render(const TriangleMesh& mesh, const Camera& camera, int width, int height) = 0;
};

/// The readable reference of the device's renderer (gpu/imaging). The result does not depend on the number of threads.
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
