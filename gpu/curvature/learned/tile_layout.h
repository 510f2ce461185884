#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/curvature/model/predictor.h"
#include "shaders/shared/curvature.h"

namespace exemplar {

/// BasisTiles in the layout of the kernels (see shared::CurvatureTile), with tiles of similar work adjacent, in
/// ranges that each fit into one binding.
struct TileLayout {
    struct Range {
        std::uint32_t first_tile, tiles;
        std::size_t first_texel, texels, first_group, groups;
    };
    std::vector<shared::CurvatureTile> table;
    std::vector<shared::uvec4> texels;
    std::vector<shared::uvec4> groups;  ///< of four entries
    std::vector<Range> ranges;
};

/// Lays out tiles in ranges of at most `max_texels_per_range` that begin at multiples of `alignment` bytes. Throws
/// DeviceLimitError if a single tile has more texels, ModelError if the tiles are inconsistent or refer to
/// components or, for principal attributes, segments that do not exist.
TileLayout lay_out_tiles(const BasisTiles& tiles, std::size_t components, std::size_t segments,
                         std::size_t max_texels_per_range, std::size_t alignment);

}  // namespace exemplar
