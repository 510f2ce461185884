#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/imaging/camera.h"
#include "host/mesh/mesh.h"

namespace exemplar {

constexpr std::uint32_t k_no_face = 0xFFFFFFFF;

/// What a camera sees of a mesh through the center of each pixel, row by row from the top left.
struct GBuffer {
    int width = 0, height = 0;
    std::vector<std::uint32_t> face;                ///< k_no_face: nothing
    std::vector<std::array<float, 2>> barycentric;  ///< of corners 1 and 2 (the rest is corner 0's), in [0, 1]
    std::vector<float> depth;                       ///< along the camera's axis, mesh units; infinity: nothing

    std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Renders the G-buffer: the readable reference of the device's. Faces are seen from both sides; the nearest counts, of
/// equally near ones the first. Barycentrics are of the surface, with perspective taken into account. The result does
/// not depend on the number of threads. Throws UsageError if the image is empty.
GBuffer render_gbuffer(const TriangleMesh& mesh, const Camera& camera, int width, int height);

}  // namespace exemplar
