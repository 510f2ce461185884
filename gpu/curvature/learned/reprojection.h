#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "gpu/curvature/learned/tile_layout.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/curvature/model/predictor.h"

namespace exemplar {

/// Vertices per invocation, in quads of four. On a CPU a loaded component serves a whole tile: D6 in
/// docs/portability.md.
inline constexpr std::array<std::uint32_t, 3> k_reprojection_quads{1, 2, 4};
inline constexpr TunableParameter k_reprojected_quads{"curvature/reproject.comp", "quads", k_reprojection_quads, 4, 1};

struct ReprojectionOptions {
    /// Maximum texels (16 bytes each) of the bases per dispatch; the device's limit applies, too.
    std::size_t max_texels_per_range = std::numeric_limits<std::size_t>::max();
    /// Vertices per invocation, in quads of four: 1, 2 or 4; 0 chooses for the device.
    std::uint32_t quads = 0;
};

/// Computes curvature from its components on the device, as reproject_curvature() does, in single precision but with
/// another order of operations.
class GpuReprojection {
  public:
    /// Throws ModelError if the tiles are inconsistent or refer to components or, for principal attributes, segments
    /// that do not exist, DeviceLimitError if they are too large for the device, UsageError for other quads.
    GpuReprojection(Device& device, const BasisTiles& tiles, std::size_t components, std::size_t segments,
                    const ReprojectionOptions& options);

    /// The surface in one frame in world space, like PosedSurface.
    struct Surface {
        const Buffer &vertices, &normals;  ///< a vec4 (x, y, z, any) per vertex; normals are unit
        /// Per segment the three rows of its rotation, a vec4 (x, y, z, 0) each, from the start of the buffer on;
        /// not read for tensors.
        const Buffer& rotations;
    };
    /// Records a dispatch per range of bases. components: a float each. Throws UsageError if the number of vertices
    /// or normals is not that of the tiles.
    void record(Stream& stream, const Buffer& components, const Surface& surface);
    /// In the layout of GpuCurvature.
    const Buffer& first() const { return first_; }
    const Buffer& second() const { return second_; }
    const Buffer& derivative() const { return derivative_; }

  private:
    void require_vectors(const Buffer& buffer, std::string_view name) const;
    std::size_t vertex_count_;
    std::vector<float> scale_;
    std::uint32_t quads_;  // of vertices per invocation
    Kernel kernel_;
    std::vector<TileLayout::Range> ranges_;
    Buffer table_, tiles_, groups_, first_, second_, derivative_;
};

}  // namespace exemplar
