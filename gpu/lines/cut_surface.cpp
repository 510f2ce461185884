#include "gpu/lines/cut_surface.h"

#include "embedded/lines_gather_comp.h"
#include "shaders/shared/lines.h"

namespace exemplar {
namespace {

using shared::GatherParameters;
using shared::vec4;

TriangleMesh cut_mesh(const TriangleMesh& whole, const SplitSurface& split) {
    TriangleMesh cut;
    cut.vertices = split.positions(whole.vertices);
    cut.faces = split.faces;
    return cut;
}

}  // namespace

GpuCutSurface::GpuCutSurface(const GpuSurface& whole, const SplitSurface& split, const CurvatureOptions& options)
    : surface_(whole.device(), cut_mesh(whole.rest(), split)),
      options_(options),
      gather_kernel_(whole.device(), shaders::lines_gather_comp,
                     {.push_constants = layout_of<GatherParameters>(),
                      .elements = {layout_of<std::uint32_t>(), layout_of<vec4>(), layout_of<vec4>()}}),
      normals_(surface_),
      source_(Buffer::of<std::uint32_t>(whole.device(), split.source)) {}

const Buffer& GpuCutSurface::gather(Stream& stream, const Buffer& whole, Buffer& cut) {
    if (!cut) cut = Buffer(surface_.device(), std::size_t{surface_.vertex_count()} * sizeof(vec4));
    stream.dispatch(gather_kernel_, surface_.vertex_count(), {source_, whole, cut},
                    GatherParameters{surface_.vertex_count()});
    return cut;
}

void GpuCutSurface::record(Stream& stream, const GpuCurvedSurface& whole) {
    const auto gathered = [&](const Buffer* from, Buffer& cut) {
        return from != nullptr ? &gather(stream, *from, cut) : nullptr;
    };
    normals_.record(stream, gather(stream, whole.vertices, vertices_));
    last_.emplace(GpuCurvedSurface{vertices_, normals_.normals(), gathered(whole.first, first_),
                                   gathered(whole.second, second_), gathered(whole.derivative, derivative_)});
}

void GpuCutSurface::record_parts(Stream& stream, const GpuCurvedSurface& whole) {
    if (!parts_) parts_.emplace(surface_, options_);
    parts_->record(stream, gather(stream, whole.vertices, vertices_));
    last_.emplace(GpuCurvedSurface{vertices_, parts_->normals(), &parts_->first(), &parts_->second(),
                                   options_.derivatives ? &parts_->derivative() : nullptr});
}

}  // namespace exemplar
