#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/mesh/curvature/tangent_tensors.h"
#include "host/mesh/vertex_neighbors.h"

namespace exemplar {

/// Diffusion of tensors in vertex frames over a surface: each becomes the mean of those around it under a Gaussian of
/// their distance, transported to its frame by the least rotation and weighted by vertex area.
///
/// A kernel of positive weights, rather than steps of the heat equation (Desbrun et al. 1999): it needs no mesh
/// Laplacian, whose weights turn negative at obtuse angles and whose explicit steps shrink with the shortest edge; it
/// can never leave the range of its input; its area weights make it a quadrature of the integral over the surface, so
/// that at a fixed width it converges under refinement and does not depend on the sampling; and at a boundary it is
/// the mean of what there is, without a condition to impose.
class TensorDiffusion {
  public:
    /// `most_bytes`: of all kernels together.
    TensorDiffusion(const VertexNeighbors& neighbors, std::size_t most_bytes);

    /// Builds the kernel of each vertex. `width` is its standard deviation in mesh units; positive and finite. Throws
    /// UsageError if the kernels take more memory than they may: where a mesh has edges much longer than the usual, as
    /// around the tip of a cone, each may hold a large part of the surface.
    void prepare(std::span<const Vec3> vertices, const std::vector<TangentFrame>& frames,
                 const std::vector<float>& areas, double width);
    void apply(std::vector<Form>& forms);
    void apply(std::vector<FormDerivative>& derivatives);

  private:
    struct Entry {
        std::uint32_t vertex;
        float weight;  ///< the weights of a kernel sum to 1
        Turn turn;     ///< from the frame of `vertex` to that of the kernel's center
    };
    /// The kernels of consecutive vertices; they keep their memory between calls.
    struct Chunk {
        std::vector<Entry> entries;
        std::vector<std::size_t> end;
    };
    struct Workspace {
        std::vector<std::uint32_t> visited;  ///< the last run that saw each vertex
        std::uint32_t run = 0;
    };
    template <typename Tensor>
    void apply_to(std::vector<Tensor>& tensors, std::vector<Tensor>& scratch);
    void add_kernel(std::uint32_t center, std::span<const Vec3> vertices, const std::vector<TangentFrame>& frames,
                    const std::vector<float>& areas, double width, Chunk& chunk, Workspace& workspace) const;

    const VertexNeighbors* neighbors_;
    std::size_t most_entries_;
    std::vector<Chunk> chunks_;
    tbb::enumerable_thread_specific<Workspace> workspaces_;
    std::vector<Form> form_scratch_;
    std::vector<FormDerivative> derivative_scratch_;
};

}  // namespace exemplar
