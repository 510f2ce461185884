#pragma once

#include <cstdint>
#include <span>

#include "host/imaging/camera.h"
#include "host/imaging/image.h"
#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Appearance of render_mesh. Light is computed in linear color: each surface gets color * (ambient * mix(ground, 1,
/// (1 + n.y) / 2) + headlight * max(0, n . to_eye)), n turned to the viewer.
struct RenderOptions {
    bool smooth = true;  ///< interpolated vertex normals; else one normal per face
    float ambient = 0.42f;
    float ground = 0.35f;  ///< light from below, as a share of the light from above (world +y)
    float headlight = 0.62f;
    Color background{255, 255, 255};
};

/// Renders a mesh on the CPU: the readable reference of the device renderer. A z-buffer rasterizer with the sample
/// positions, the top-left fill rule and the depth range of Vulkan, on 2 x 2 samples per pixel averaged in linear
/// color. face_colors holds one sRGB color per face. Returns an RGB image; the same input gives the same bytes on
/// any number of threads. Throws UsageError if the image is empty or the number of colors is not the number of
/// faces.
Image render_mesh(const TriangleMesh& mesh, std::span<const Color> face_colors, const Camera& camera, int width,
                  int height, const RenderOptions& options = {});

/// Convert between sRGB-encoded and linear values in [0, 1].
float srgb_to_linear(float encoded);
float linear_to_srgb(float linear);

}  // namespace exemplar
