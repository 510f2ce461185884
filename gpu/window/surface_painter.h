#pragma once

#include <volk.h>

#include "gpu/runtime/buffer.h"
#include "gpu/runtime/draw_pipeline.h"
#include "gpu/runtime/pass.h"
#include "host/imaging/camera.h"
#include "host/mesh/labels.h"
#include "shaders/shared/window.h"

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
    smooth = shared::k_light_smooth,
    flat = shared::k_light_flat,
    none = shared::k_light_none,
    steps = shared::k_light_steps  ///< in three steps, by vertex normals
};

/// How a surface is painted and lit. Curvature goes from blue (hollow) over gray to red (convex).
struct PaintLook {
    SurfacePaint paint = SurfacePaint::plain;
    SurfaceLight light = SurfaceLight::smooth;
    Color plain{214, 212, 206};
    float strongest_curvature = 1;  ///< has the strongest color; in 1 / mesh units, positive
};

/// The buffers of a posed surface, as the kernels of gpu/curvature lay them out. `colors` (a uint per face, sRGB, red
/// lowest) and the curvatures may be left out if the look does without.
struct PaintedSurface {
    std::uint32_t face_count = 0;
    const Buffer* faces = nullptr;
    const Buffer* vertices = nullptr;
    const Buffer* normals = nullptr;
    const Buffer* colors = nullptr;
    const Buffer* first = nullptr;
    const Buffer* second = nullptr;
};

/// Whether a look needs curvature.
bool paints_curvature(SurfacePaint paint);

/// Draws surfaces that are on the device already.
class SurfacePainter {
  public:
    SurfacePainter(Device& device, VkFormat color, VkFormat depth);
    /// Adds the surface to a pass with color and depth.
    void draw(Pass& pass, const PaintedSurface& surface, const Camera& camera, const PaintLook& look) const;

  private:
    DrawPipeline pipeline_;
};

}  // namespace exemplar
