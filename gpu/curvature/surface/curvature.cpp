#include "gpu/curvature/surface/curvature.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "embedded/curvature_curvature_comp.h"
#include "embedded/curvature_derivative_comp.h"
#include "embedded/curvature_smooth_derivatives_comp.h"
#include "embedded/curvature_smooth_forms_comp.h"
#include "gpu/curvature/surface/near_vertices.h"
#include "host/core/errors.h"
#include "host/core/memory_budget.h"
#include "host/mesh/curvature/near_flood.h"

namespace exemplar {
namespace {

using shared::DiffusionParameters;
using shared::SurfaceParameters;
using shared::uvec4;
using shared::vec4;

// Share of a Gaussian's variance that is left when it is cut off; as in host/mesh/curvature/tensor_diffusion.cpp.
double kept_variance() {
    const double cutoff = shared::k_diffusion_cutoff, rest = std::exp(-cutoff);
    return (1 - (1 + cutoff + cutoff * cutoff / 2) * rest) / (1 - (1 + cutoff) * rest);
}

double squared_radius(double width) {
    return 2 * shared::k_diffusion_cutoff / kept_variance() * width * width;
}

// Returns the standard deviation in mesh units; 0 for no smoothing. `edge`: the median length.
double smoothing_width(const CurvatureOptions& options, double edge) {
    if (!(options.smoothing >= 0 && std::isfinite(options.smoothing) && options.smoothing_unit >= 0 &&
          std::isfinite(options.smoothing_unit)))
        throw UsageError(fmt::format("smoothing by {} x {}: give a width that is finite and not negative",
                                     options.smoothing, options.smoothing_unit));
    if (options.robust != RobustEstimator::none)
        throw UsageError("robust fits of curvature run on the host only; use CurvatureEstimator");
    return options.smoothing * (options.smoothing_unit > 0 ? options.smoothing_unit : edge);
}

// Bindings of a kernel: where the rows of a list of vertices begin, the list, and `attributes` buffers of vec4 per
// vertex.
template <typename Parameters>
KernelInterface gathering_interface(std::size_t attributes, bool smoothed) {
    KernelInterface interface {
        .push_constants = layout_of<Parameters>(), .elements = { layout_of<std::uint32_t>(), layout_of<uvec4>() }
    };
    interface.elements.insert(interface.elements.end(), attributes, layout_of<vec4>());
    if (smoothed) interface.constants = {{0, 1}};
    return interface;
}

Buffer attribute(const GpuSurface& surface) {
    return {surface.device(), std::size_t{surface.vertex_count()} * sizeof(vec4)};
}

}  // namespace

GpuCurvature::Diffusion::Diffusion(const GpuSurface& surface, double width, std::size_t enough, bool with_derivatives)
    : angular_components(attribute(surface)),
      forms(surface.device(), shaders::curvature_smooth_forms_comp,
            gathering_interface<DiffusionParameters>(5, false)) {
    const DeviceInfo& info = surface.device().info();
    // A device may claim more memory than the machine has, and building the lists takes a few copies of them.
    const std::size_t max_bytes = std::min<std::size_t>(info.max_allocation, usable_memory() / 16);
    const double radius = std::sqrt(squared_radius(width));
    const NearVertices rows =
        build_near_vertices(surface.rest(), {.radius = radius, .reach = k_smoothing_reach * radius, .enough = enough},
                            max_bytes / sizeof(uvec4));
    near_begin = Buffer::of<std::uint32_t>(surface.device(), rows.begin);
    near = Buffer::of<uvec4>(surface.device(), rows.texels);
    const double scaled = width * static_cast<double>(surface.scale());
    for (const NearTile& tile : tile_rows(rows, info.max_texels, info.texel_alignment / sizeof(uvec4)))
        tiles.push_back({.parameters = {.first = tile.first,
                                        .vertices = tile.count,
                                        .near_first = tile.first_texel,
                                        .scale = surface.scale(),
                                        .exponent = static_cast<float>(-0.5 * kept_variance() / (scaled * scaled)),
                                        .limit = static_cast<float>(squared_radius(scaled))},
                         .offset = tile.first_texel * sizeof(uvec4),
                         .bytes = tile.texels * sizeof(uvec4)});
    if (with_derivatives)
        derivatives = Kernel(surface.device(), shaders::curvature_smooth_derivatives_comp,
                             gathering_interface<DiffusionParameters>(5, false));
}

void GpuCurvature::Diffusion::record(Stream& stream, const Kernel& kernel, const Buffer& vertices,
                                     const Buffer& normals, const Buffer& sixth, const Buffer& seventh) const {
    for (const Tile& tile : tiles)
        stream.dispatch(kernel, tile.parameters.vertices,
                        {near_begin, BufferRange(near, tile.offset, tile.bytes), vertices, normals, angular_components,
                         sixth, seventh},
                        tile.parameters);
}

GpuCurvature::GpuCurvature(const GpuSurface& surface, const CurvatureOptions& options)
    : surface_(surface), normals_(surface), first_(attribute(surface)), second_(attribute(surface)) {
    const TriangleMesh& rest = surface.rest();
    const double edge = options.smoothing > 0
                            ? CurvatureEstimator(rest.faces, rest.vertex_count()).median_edge_length(rest.vertices)
                            : 0;
    const double width = smoothing_width(options, edge);
    const bool smoothed = width > 0 && std::isfinite(width);
    if (smoothed) diffusion_.emplace(surface, width, enough_near_vertices(width / edge), options.derivatives);
    curvature_kernel_ = Kernel(surface.device(), shaders::curvature_curvature_comp,
                               gathering_interface<SurfaceParameters>(4, smoothed));
    if (!options.derivatives) return;
    derivative_kernel_ = Kernel(surface.device(), shaders::curvature_derivative_comp,
                                gathering_interface<SurfaceParameters>(5, smoothed));
    derivative_ = attribute(surface);
}

void GpuCurvature::record(Stream& stream, const Buffer& vertices) {
    normals_.record(stream, vertices);
    const std::uint32_t count = surface_.vertex_count();
    const Buffer &begin = surface_.ring_begin(), &rings = surface_.rings();
    stream.dispatch(curvature_kernel_, count,
                    {begin, rings, vertices, normals(), diffusion_ ? diffusion_->angular_components : first_, second_},
                    surface_.parameters());
    if (diffusion_) diffusion_->record(stream, diffusion_->forms, vertices, normals(), first_, second_);
    if (!derivative_) return;
    stream.dispatch(
        derivative_kernel_, count,
        {begin, rings, vertices, first_, second_, normals(), diffusion_ ? diffusion_->angular_components : derivative_},
        surface_.parameters());
    if (diffusion_) diffusion_->record(stream, diffusion_->derivatives, vertices, normals(), first_, derivative_);
}

}  // namespace exemplar
