#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <map>

#include "gpu/runtime/kernels/draw_pipeline.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/pass.h"
#include "host/imaging/camera.h"
#include "host/mesh/labels.h"
#include "shaders/shared/paint.h"

namespace exemplar {

enum class SurfacePaint : std::uint32_t {
    plain = shared::k_paint_plain,
    faces = shared::k_paint_faces,  ///< a color per face
    mean_curvature = shared::k_paint_mean,
    gaussian_curvature = shared::k_paint_gauss,  ///< the root of |k1 k2|, with the sign of k1 k2
    first_curvature = shared::k_paint_first,
    second_curvature = shared::k_paint_second,
    normals = shared::k_paint_normals
};

enum class SurfaceLight : std::uint32_t {
    smooth = shared::k_light_smooth,  ///< the light of RenderOptions, by vertex normals
    flat = shared::k_light_flat,      ///< the light of RenderOptions, by face normals
    none = shared::k_light_none,
    steps = shared::k_light_steps,         ///< headlight in three steps, by vertex normals
    headlight = shared::k_light_headlight  ///< headlight by vertex normals; colors stay light
};

/// Paint, light and background of a surface. Curvature goes from blue (concave) over gray to red (convex).
struct PaintLook {
    SurfacePaint paint = SurfacePaint::plain;
    SurfaceLight light = SurfaceLight::smooth;
    Color plain{214, 212, 206};
    float full_color_curvature = 1;  ///< curvature with the strongest color; in 1 / mesh units, positive
    Color background{255, 255, 255};
    bool transparent = false;        ///< no background
    bool transparent_plain = false;  ///< if `transparent`, plain paint is invisible, too: the surface only occludes
};

/// The buffers of a posed surface, in the layout of the kernels of gpu/curvature. A look that needs a missing buffer
/// is drawn plain instead.
struct PaintedSurface {
    std::uint32_t face_count = 0;
    const Buffer* faces = nullptr;  ///< a uvec4 (a, b, c, 0) per face
    /// Three uints per face: an index buffer, used if the look allows. Without it vertex shaders run once per
    /// corner.
    const Buffer* indices = nullptr;
    const Buffer* vertices = nullptr;
    const Buffer* normals = nullptr;
    const Buffer* colors = nullptr;  ///< a packed_color per face
    const Buffer* first = nullptr;
    const Buffer* second = nullptr;
};

/// Returns whether a paint needs curvature.
bool paints_curvature(SurfacePaint paint);

/// Returns the clear color of a pass for this look: sRGB, multiplied by its alpha.
std::array<float, 4> background_of(const PaintLook& look);

/// Draws surfaces that are already on the device, as sRGB multiplied by alpha. Each combination of paint and light
/// has a pipeline of its own, made on first use (D2 in docs/portability.md).
class SurfacePainter {
  public:
    SurfacePainter(Device& device, VkFormat color, VkFormat depth) : device_(device), color_(color), depth_(depth) {}
    /// Adds the surface to a pass with color and depth. Throws DeviceError if the device cannot draw.
    void draw(Pass& pass, const PaintedSurface& surface, const Camera& camera, const PaintLook& look);

  private:
    /// Values of the specialization constants: paint, light, whether vertices are drawn by corner.
    using Variant = std::array<std::uint32_t, 3>;
    const DrawPipeline& pipeline(const Variant& variant);
    Device& device_;
    VkFormat color_, depth_;
    std::map<Variant, DrawPipeline> pipelines_;
};

}  // namespace exemplar
