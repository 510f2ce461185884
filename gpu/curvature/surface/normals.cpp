#include "gpu/curvature/surface/normals.h"

#include "embedded/curvature_normals_comp.h"

namespace exemplar {

using shared::SurfaceParameters;
using shared::uvec4;
using shared::vec4;

GpuNormals::GpuNormals(const GpuSurface& surface)
    : surface_(surface),
      kernel_(surface.device(), shaders::curvature_normals_comp,
              {.push_constants = layout_of<SurfaceParameters>(),
               .elements = {layout_of<std::uint32_t>(), layout_of<uvec4>(), layout_of<vec4>(), layout_of<vec4>()}}),
      normals_(surface.device(), std::size_t{surface.vertex_count()} * sizeof(vec4)) {}

void GpuNormals::record(Stream& stream, const Buffer& vertices) {
    surface_.check_vertices(vertices);
    stream.dispatch(kernel_, surface_.vertex_count(), {surface_.ring_begin(), surface_.rings(), vertices, normals_},
                    surface_.parameters());
}

}  // namespace exemplar
