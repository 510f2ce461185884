#pragma once

#include <cstdint>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/buffer.h"
#include "host/mesh/mesh.h"
#include "shaders/shared/curvature.h"

namespace exemplar {

/// The topology of a deforming surface on the device, shared by all kernels that work on its vertices and faces. It
/// is constant; the vertices, a vec4 (x, y, z, 1) each, change with every frame.
class GpuSurface {
  public:
    /// `rest`: any frame of the surface, from which its scale and the neighborhoods of vertices are taken. Throws
    /// MeshError if a face has a vertex that does not exist, DeviceLimitError if it exceeds the device's texel limit
    /// or a vertex has too many faces.
    GpuSurface(Device& device, TriangleMesh rest);

    Device& device() const { return *device_; }
    std::uint32_t vertex_count() const { return vertex_count_; }
    std::uint32_t face_count() const { return face_count_; }
    /// Returns the surface given to the constructor.
    const TriangleMesh& rest() const { return rest_; }
    /// A uvec4 (a, b, c, 0) per face.
    const Buffer& faces() const { return faces_; }
    /// The same as three uints per face.
    const Buffer& indices() const { return indices_; }
    /// The rings of the vertices (build_vertex_rings) as compressed rows: a uint per vertex, and uvec4s.
    const Buffer& ring_begin() const { return ring_begin_; }
    const Buffer& rings() const { return rings_; }
    /// Returns the power of two that scales the mean edge at rest to about 1, so that squares and cubes of lengths
    /// neither overflow nor underflow in single precision.
    float scale() const { return scale_; }

    shared::SurfaceParameters parameters() const { return {vertex_count_, scale_}; }
    /// Throws UsageError unless `vertices` has a vec4 per vertex.
    void check_vertices(const Buffer& vertices) const;

  private:
    Device* device_;
    TriangleMesh rest_;
    std::uint32_t vertex_count_, face_count_;
    float scale_;
    Buffer faces_, indices_, ring_begin_, rings_;
};

}  // namespace exemplar
