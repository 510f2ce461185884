#include "gpu/curvature/curvature.h"

#include "embedded/curvature_curvature_comp.h"
#include "embedded/curvature_derivative_comp.h"

namespace exemplar {
namespace {

using shared::SurfaceParameters;
using shared::uvec4;
using shared::vec4;

// Rings, positions, and three buffers of a vec4 per vertex.
KernelInterface gathering_interface() {
    return {.push_constants = layout_of<SurfaceParameters>(),
            .elements = {layout_of<std::uint32_t>(), layout_of<uvec4>(), layout_of<vec4>(), layout_of<vec4>(),
                         layout_of<vec4>(), layout_of<vec4>()}};
}

}  // namespace

GpuCurvature::GpuCurvature(const GpuSurface& surface, bool derivatives)
    : surface_(surface),
      normals_(surface),
      curvature_kernel_(surface.device(), shaders::curvature_curvature_comp, gathering_interface()) {
    const std::size_t bytes = std::size_t{surface.vertex_count()} * sizeof(vec4);
    first_ = Buffer(surface.device(), bytes);
    second_ = Buffer(surface.device(), bytes);
    if (!derivatives) return;
    derivative_kernel_ = Kernel(surface.device(), shaders::curvature_derivative_comp, gathering_interface());
    derivative_ = Buffer(surface.device(), bytes);
}

void GpuCurvature::record(Stream& stream, const Buffer& vertices) {
    normals_.record(stream, vertices);
    const Buffer &begin = surface_.ring_begin(), &rings = surface_.rings();
    stream.dispatch(curvature_kernel_, surface_.vertex_count(), {begin, rings, vertices, normals(), first_, second_},
                    surface_.parameters());
    if (derivative_)
        stream.dispatch(derivative_kernel_, surface_.vertex_count(),
                        {begin, rings, vertices, first_, second_, derivative_}, surface_.parameters());
}

}  // namespace exemplar
