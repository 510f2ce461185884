#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/curvature/near_flood.h"
#include "host/mesh/curvature/tangent_tensors.h"
#include "host/mesh/mesh.h"
#include "host/mesh/vertex_neighbors.h"

namespace exemplar {

/// Smooths tensors in vertex frames over a surface. Each becomes the mean of the tensors around it, weighted by
/// vertex area and by a Gaussian of their distance, and transported to its frame by the smallest rotation.
///
/// A kernel of positive weights replaces steps of the heat equation (Desbrun et al. 1999): it needs no Laplacian,
/// whose weights turn negative at obtuse angles and whose explicit steps shrink with the shortest edge. Results stay
/// within the range of the input. Area weights make it a quadrature over the surface, which converges under
/// refinement at a fixed width and does not depend on the sampling. It needs no boundary condition.
class TensorDiffusion {
  public:
    /// `max_bytes` is the maximum memory of all kernels together.
    TensorDiffusion(const VertexNeighbors& neighbors, std::size_t max_bytes);

    /// Builds the kernel of each vertex. `width` is its standard deviation in mesh units, positive and finite. Kernels
    /// end with the ring in which they have `enough` vertices (see NearFlood). Throws UsageError if the kernels exceed
    /// the memory limit.
    void prepare(std::span<const Vec3> vertices, const std::vector<TangentFrame>& frames,
                 const std::vector<float>& areas, double width, std::size_t enough);
    void apply(std::vector<Form>& forms);
    void apply(std::vector<FormDerivative>& derivatives);

  private:
    struct Entry {
        std::uint32_t vertex;
        float weight;          ///< the weights of a kernel sum to 1
        TangentRotation turn;  ///< from the frame of `vertex` to that of the kernel's center
    };
    /// The kernels of consecutive vertices. Buffers are kept between calls.
    struct Chunk {
        std::vector<Entry> entries;
        std::vector<std::size_t> end;
    };
    template <typename Tensor>
    void apply_to(std::vector<Tensor>& tensors, std::vector<Tensor>& scratch);
    void add_kernel(std::uint32_t center, std::span<const Vec3> vertices, const std::vector<TangentFrame>& frames,
                    const std::vector<float>& areas, double width, Chunk& chunk, NearFlood& flood) const;

    const VertexNeighbors* neighbors_;
    std::size_t max_entries_;
    std::vector<Chunk> chunks_;
    std::vector<Form> form_scratch_;
    std::vector<FormDerivative> derivative_scratch_;
};

}  // namespace exemplar
