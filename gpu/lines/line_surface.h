#pragma once

#include <cstdint>
#include <span>

#include "gpu/curvature/surface/curved_surface.h"
#include "gpu/curvature/surface/surface.h"
#include "gpu/runtime/record/buffer.h"
#include "host/lines/extraction/lines.h"

namespace exemplar {

/// What lines need to know of a surface's topology beside GpuSurface.
class GpuLineSurface {
  public:
    /// `surface` must live as long as this. Throws as build_face_neighbors, and DeviceLimitError if kernels cannot see
    /// all of it.
    explicit GpuLineSurface(const GpuSurface& surface);

    const GpuSurface& surface() const { return *surface_; }
    /// A uvec4 per face: the FaceNeighbors, and 0.
    const Buffer& neighbors() const { return neighbors_; }
    /// The faces around the vertices: a uint per vertex and one more, and uints.
    const Buffer& face_begin() const { return face_begin_; }
    const Buffer& vertex_faces() const { return vertex_faces_; }
    /// Whether no edge is that of a single face.
    bool is_closed() const { return closed_; }

  private:
    const GpuSurface* surface_;
    bool closed_ = true;
    Buffer neighbors_, face_begin_, vertex_faces_;
};

/// The families of kernels (shared::k_contours and so on) that make up these types, a bit each.
std::uint32_t line_families(std::span<const LineType> types);
/// The type that a family is of.
LineType type_of_family(std::uint32_t family);

}  // namespace exemplar
