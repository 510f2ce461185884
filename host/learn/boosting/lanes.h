#pragma once

#include <tbb/cache_aligned_allocator.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace exemplar {

/// Vector types of the compiler: the weights of one row for up to eight classes ("lanes") are added as one value.
/// They work on every instruction set; with AVX an operation on eight floats is one instruction.
template <int width>
struct LaneTypes {
    using Floats [[gnu::vector_size(width * 4), gnu::may_alias]] = float;
    using Doubles [[gnu::vector_size(width * 8), gnu::may_alias]] = double;
};
template <int width>
using LaneFloats = typename LaneTypes<width>::Floats;
template <int width>
using LaneDoubles = typename LaneTypes<width>::Doubles;

constexpr std::size_t k_max_lanes = 8;

/// Floats that start on a cache line, as LaneFloats need.
using AlignedFloats = std::vector<float, tbb::cache_aligned_allocator<float>>;
using AlignedDoubles = std::vector<double, tbb::cache_aligned_allocator<double>>;

/// Factors per lane (padded): `own` for rows of the lane's class, `other` for all others.
struct LaneFactors {
    std::vector<double> own, other;
};

/// Lanes of the classes are padded to a power of two up to 8; more classes take several panels of 8 lanes.
struct LaneLayout {
    std::size_t lanes = 1;   ///< classes
    std::size_t width = 1;   ///< lanes per panel: 1, 2, 4 or 8
    std::size_t panels = 1;  ///< panels of `width` lanes

    explicit LaneLayout(std::size_t lane_count)
        : lanes(lane_count),
          width(lane_count < k_max_lanes ? std::bit_ceil(lane_count) : k_max_lanes),
          panels((lane_count + width - 1) / width) {}
    std::size_t padded() const { return width * panels; }
};

/// Calls the body with the layout's width as a template argument, that is as a compile-time constant.
template <typename Body>
void with_width(const LaneLayout& layout, Body&& body) {
    switch (layout.width) {
        case 1:
            return body.template operator()<1>();
        case 2:
            return body.template operator()<2>();
        case 4:
            return body.template operator()<4>();
        default:
            return body.template operator()<8>();
    }
}

}  // namespace exemplar
