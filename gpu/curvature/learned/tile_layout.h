#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/curvature/model/predictor.h"
#include "shaders/shared/curvature.h"

namespace exemplar {

/// BasisTiles as kernels read them (see shared::CurvatureTile), ordered by what there is to add up, in ranges of which
/// one binding sees each.
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

/// No range has more than `most_texels`, and each begins at a multiple of `alignment` bytes. Throws DeviceLimitError if
/// a single tile has more, ModelError if the tiles contradict themselves or refer to more than `components` or,
/// if principal, `segments`.
TileLayout lay_out_tiles(const BasisTiles& tiles, std::size_t components, std::size_t segments, std::size_t most_texels,
                         std::size_t alignment);

}  // namespace exemplar
