#include "gpu/curvature/learned/reprojection.h"

#include <fmt/format.h>

#include <algorithm>

#include "embedded/curvature_reproject_comp.h"
#include "gpu/curvature/surface/texels.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

using shared::CurvatureTile;
using shared::k_tile_quads;
using shared::ReprojectionParameters;
using shared::uvec4;
using shared::vec4;

// The kernel fetches each as one four-component vector.
static_assert(sizeof(CurvatureTile) == 16);

// The kernel has copies.
static_assert(k_min_flatness == 1e-6f && k_min_divisor == 0.2f);

Kernel make_kernel(Device& device, AttributeSet set, std::uint32_t quads) {
    return {
        device,
        shaders::curvature_reproject_comp,
        {.push_constants = layout_of<ReprojectionParameters>(),
         .elements = {layout_of<uvec4>(), layout_of<uvec4>(), layout_of<uvec4>(), layout_of<float>(), layout_of<vec4>(),
                      layout_of<vec4>(), layout_of<vec4>(), layout_of<vec4>(), layout_of<vec4>(), layout_of<vec4>()},
         .constants = {{0, set == AttributeSet::principal ? 1u : 0u}, {1, quads}}}};
}

}  // namespace

GpuReprojection::GpuReprojection(Device& device, const BasisTiles& tiles, std::size_t components, std::size_t segments,
                                 const ReprojectionOptions& options)
    : vertex_count_(tiles.vertex_count),
      scale_(tiles.scale),
      quads_(options.quads != 0 ? options.quads : device.choose(k_reprojected_quads)),
      kernel_(make_kernel(device, tiles.set, quads_)) {
    if (quads_ != 1 && quads_ != 2 && quads_ != k_tile_quads)
        throw UsageError(fmt::format("vertices are re-projected by 4, 8 or 16, not by 4 x {}", quads_));
    check_texels(device, std::max({tiles.tile_count(), vertex_count_, components, 3 * segments}),
                 "the vertices of a curvature model");
    const TileLayout layout = lay_out_tiles(
        tiles, components, segments, std::min<std::size_t>(options.max_texels_per_range, device.info().max_texels),
        device.info().texel_alignment);
    scale_.resize(k_max_attributes, 0.0f);
    ranges_ = layout.ranges;
    table_ = Buffer::of<CurvatureTile>(device, layout.table);
    tiles_ = Buffer::of<uvec4>(device, layout.texels);
    groups_ = Buffer::of<uvec4>(device, layout.groups);
    for (Buffer* const output : {&first_, &second_, &derivative_})
        *output = Buffer(device, vertex_count_ * sizeof(vec4));
}

void GpuReprojection::require_vectors(const Buffer& buffer, std::string_view name) const {
    if (buffer.bytes() != vertex_count_ * sizeof(vec4))
        throw UsageError(
            fmt::format("a curvature model of {} vertices needs {} of {} bytes, not {}; take those "
                        "of the surface it was learned on",
                        vertex_count_, name, vertex_count_ * sizeof(vec4), buffer.bytes()));
}

void GpuReprojection::record(Stream& stream, const Buffer& components, const Surface& surface) {
    require_vectors(surface.vertices, "vertices");
    require_vectors(surface.normals, "normals");
    for (const TileLayout::Range& range : ranges_)
        stream.dispatch(
            kernel_, std::size_t{range.tiles} * (k_tile_quads / quads_),
            {table_, BufferRange(tiles_, range.first_texel * sizeof(uvec4), range.texels * sizeof(uvec4)),
             BufferRange(groups_, range.first_group * sizeof(uvec4), range.groups * sizeof(uvec4)), components,
             surface.rotations, surface.vertices, surface.normals, first_, second_, derivative_},
            ReprojectionParameters{.low_scales = {scale_[0], scale_[1], scale_[2], scale_[3]},
                                   .high_scales = {scale_[4], scale_[5], scale_[6], scale_[7]},
                                   .first_tile = range.first_tile,
                                   .tiles = range.tiles,
                                   .first_texel = static_cast<std::uint32_t>(range.first_texel),
                                   .first_group = static_cast<std::uint32_t>(range.first_group)});
}

}  // namespace exemplar
