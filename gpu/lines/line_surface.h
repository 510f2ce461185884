#pragma once

#include <cstdint>
#include <span>

#include "gpu/curvature/surface/curved_surface.h"
#include "gpu/curvature/surface/surface.h"
#include "gpu/runtime/record/buffer.h"
#include "host/lines/extraction/lines.h"

namespace exemplar {

/// Topology of a surface that lines need in addition to GpuSurface.
class GpuLineSurface {
  public:
    /// `surface` must live as long as this. Throws as build_face_neighbors does, and DeviceLimitError if it exceeds
    /// the device's texel limit.
    explicit GpuLineSurface(const GpuSurface& surface);
    /// The same for a surface that was cut open along its sharp edges. `neighbors`, `joined`: of its faces before that
    /// (mark_sharp_edges, LineSurface::uncut). Throws UsageError if there are not as many.
    GpuLineSurface(const GpuSurface& surface, std::span<const FaceNeighbors> neighbors, std::span<const Face> joined);

    const GpuSurface& surface() const { return *surface_; }
    /// A uvec4 per face: its FaceNeighbors and 0.
    const Buffer& neighbors() const { return neighbors_; }
    /// A uvec4 per face: its vertices before the surface was cut open, and 0.
    const Buffer& joined_faces() const { return joined_faces_; }
    /// The faces around these vertices as compressed rows: a uint per vertex and one more, and uints.
    const Buffer& face_begin() const { return face_begin_; }
    const Buffer& vertex_faces() const { return vertex_faces_; }
    /// Returns whether no edge has a single face.
    bool is_closed() const { return closed_; }

  private:
    const GpuSurface* surface_;
    bool closed_ = true;
    Buffer neighbors_, joined_faces_, face_begin_, vertex_faces_;
};

/// Returns the families of kernels (shared::k_contours and so on) of these types, a bit each.
std::uint32_t line_families(std::span<const LineType> types);
/// Returns the type of a family.
LineType type_of_family(std::uint32_t family);

}  // namespace exemplar
