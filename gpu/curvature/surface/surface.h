#pragma once

#include <cstdint>

#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/device/device.h"
#include "host/mesh/mesh.h"
#include "shaders/shared/curvature.h"

namespace exemplar {

/// The topology of a deforming surface on the device, shared by all kernels that work on its vertices and faces. It
/// stays; the vertices, a vec4 (x, y, z, 1) each, change with every frame.
class GpuSurface {
  public:
    /// `rest` is any frame of the surface; its vertices tell the scale of the mesh, and what may come near what. Throws
    /// MeshError if a face refers to a vertex that does not exist, DeviceLimitError if kernels cannot see all of it.
    GpuSurface(Device& device, TriangleMesh rest);

    Device& device() const { return *device_; }
    std::uint32_t vertex_count() const { return vertex_count_; }
    std::uint32_t face_count() const { return face_count_; }
    /// The surface as it was given.
    const TriangleMesh& rest() const { return rest_; }
    /// A uvec4 (a, b, c, 0) per face.
    const Buffer& faces() const { return faces_; }
    /// The same as three uints per face.
    const Buffer& indices() const { return indices_; }
    /// The rings of the vertices (build_vertex_rings): a uint per vertex, and uvec4s.
    const Buffer& ring_begin() const { return ring_begin_; }
    const Buffer& rings() const { return rings_; }
    /// The power of two that makes the edges at rest about 1 long, so that squares and cubes of lengths neither
    /// overflow nor underflow in single precision.
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
