#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "host/imaging/camera.h"
#include "host/mesh/mesh.h"

namespace exemplar {

constexpr std::uint32_t k_no_face = 0xFFFFFFFF;

/// The visible surface point of one sample of an image.
struct VisibleSample {
    double depth = std::numeric_limits<double>::infinity();  ///< depth in clip space, in [0, 1]
    std::uint32_t face = k_no_face;
    Vec3 weight = Vec3::Zero();  ///< barycentric coordinates on the surface, perspective-correct
};

/// Rasterizes a mesh with a z-buffer, by the fill rule and the depth range of Vulkan. Returns what the camera sees
/// through the centers of columns x rows cells (both positive), row by row from the top left. Faces have two sides
/// and are clipped at the near and far planes; of equally near ones the first is visible. The result does not depend
/// on the number of threads.
std::vector<VisibleSample> visible_samples(const TriangleMesh& mesh, const Camera& camera, int columns, int rows);

}  // namespace exemplar
