#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "gpu/curvature/learned/tile_layout.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/stream.h"
#include "host/curvature/model/predictor.h"

namespace exemplar {

/// Vertices per invocation, by four.
inline constexpr std::array<std::uint32_t, 3> k_reprojection_quads{1, 2, 4};
inline constexpr TunableParameter k_reprojected_quads{"curvature/reproject.comp", "quads", k_reprojection_quads};

struct ReprojectionOptions {
    /// The bases are read in ranges of at most so many texels (16 bytes each), and of what the device allows.
    std::size_t most_texels = std::numeric_limits<std::size_t>::max();
    /// Vertices per invocation, by four: 1, 2 or 4; 0 is what suits the device.
    std::uint32_t quads = 0;
};

/// Curvature from its components on the device, as reproject_curvature(). Products are rounded in single precision in
/// another order.
class GpuReprojection {
  public:
    /// Throws ModelError if the tiles contradict themselves or refer to more than `components` or, if principal,
    /// `segments`, DeviceLimitError if they are too large for the device, UsageError for another number of quads.
    GpuReprojection(Device& device, const BasisTiles& tiles, std::size_t components, std::size_t segments,
                    const ReprojectionOptions& options);

    /// The surface at one moment, in the world, as PosedSurface.
    struct Surface {
        const Buffer &vertices, &normals;  ///< a vec4 (x, y, z, any) per vertex; normals are unit
        /// Of each segment three rows, a vec4 (x, y, z, 0) each, at the begin of the buffer; anything for tensors.
        const Buffer& rotations;
    };
    /// A dispatch for each range. components: a float each. Throws UsageError if there are not as many vertices or
    /// normals as the tiles have.
    void record(Stream& stream, const Buffer& components, const Surface& surface);
    /// As those of GpuCurvature.
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
