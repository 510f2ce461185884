// Directions of strokes interpolated between pixels, and barriers (host/hatching/placement/stroke_directions.cpp,
// placement_grid.cpp).
#ifndef EXEMPLAR_ORIENTATIONS_GLSL
#define EXEMPLAR_ORIENTATIONS_GLSL
#include "shaders/hatching/placement_grid.glsl"

const int k_min_agreement = 358;  // minimum length of a mean of directions, in shares

// Return 1 if no barrier is to the right of a pixel, or below it.
uint free_along(uvec4 texel) {
    return uint((texel.w & k_right_barrier) == 0u);
}
uint free_down(uvec4 texel) {
    return uint((texel.w & k_lower_barrier) == 0u);
}

// Returns whether no barrier blocks a step from a pixel to itself or one of its eight neighbors.
bool is_free_step(ivec2 from, ivec2 to) {
    const ivec2 a = from >> k_pixel_bits, b = to >> k_pixel_bits, low = min(a, b);
    const uint along = uint(a.x != b.x), down = uint(a.y != b.y);
    const uint along_here = free_along(texel_at(ivec2(low.x, a.y))) | (1u - along);
    const uint along_there = free_along(texel_at(ivec2(low.x, b.y))) | (1u - along);
    const uint down_here = free_down(texel_at(ivec2(a.x, low.y))) | (1u - down);
    const uint down_there = free_down(texel_at(ivec2(b.x, low.y))) | (1u - down);
    return ((along_here & down_there) | (down_here & along_there)) != 0u;
}

// Returns the direction at half the angle of `sum`, of length `size`, with the sign nearer to `heading`.
ivec2 half_angle(ivec2 sum, int size, ivec2 heading) {
    const ivec2 halved =
        direction_of(mix(ivec2(sum.y, size - sum.x), ivec2(size + sum.x, sum.y), bvec2(sum.x >= 0)));
    return mix(halved, -halved, bvec2(dot_of(halved, heading) < 0));
}

// Adds a direction times a weight; z accumulates the weights.
void add_direction(uvec4 texel, uint layer, uint reached, int weight, inout ivec3 sum) {
    const int word = int(direction_word(texel, layer));
    const int counted = weight * int(reached) * int(word != 0);
    sum += counted * ivec3(bitfieldExtract(word, 0, 16), bitfieldExtract(word, 16, 16), 1);
}

// Returns the direction of a layer's strokes at a point, with the sign nearer to `heading`; zero if there is none.
ivec2 direction_at(uint layer, ivec2 point, ivec2 heading) {
    const ivec2 from_center = point - k_pixel / 2, corner = from_center >> k_pixel_bits;
    const bvec2 is_low = equal(point >> k_pixel_bits, corner);  // where the point's own pixel is among the four
    const uvec4 t00 = texel_at(corner), t10 = texel_at(corner + ivec2(1, 0)), t01 = texel_at(corner + ivec2(0, 1)),
                t11 = texel_at(corner + ivec2(1, 1));
    const uvec2 along = mix(uvec2(free_along(t01), free_along(t00)), uvec2(free_along(t00), free_along(t01)), is_low.yy);
    const uvec2 down = mix(uvec2(free_down(t10), free_down(t00)), uvec2(free_down(t00), free_down(t10)), is_low.xx);
    // The point's own pixel, its horizontal neighbor, its vertical neighbor, its diagonal neighbor.
    const uvec4 reached = uvec4(1u, along.x, down.x, (along.x & down.y) | (down.x & along.y));
    const uvec4 by_column = mix(reached.yxwz, reached, bvec4(is_low.x));
    const uvec4 by_place = mix(by_column.zwxy, by_column, bvec4(is_low.y));

    const ivec2 high = (from_center & (k_pixel - 1)) >> 4, low = 256 - high;
    ivec3 sum = ivec3(0);
    add_direction(t00, layer, by_place.x, low.x * low.y, sum);
    add_direction(t10, layer, by_place.y, high.x * low.y, sum);
    add_direction(t01, layer, by_place.z, low.x * high.y, sum);
    add_direction(t11, layer, by_place.w, high.x * high.y, sum);
    const ivec2 mean = (sum.xy + (1 << 15)) >> 16;
    const int size = int(floor_sqrt(uint(dot_of(mean, mean))));
    const uvec4 own = mix(mix(t11, t01, bvec4(is_low.x)), mix(t10, t00, bvec4(is_low.x)), bvec4(is_low.y));
    const bool known = all(bvec3(direction_word(own, layer) != 0u, size != 0, size << 12 >= sum.z * k_min_agreement));
    return half_angle(mean, size, heading) * int(known);
}

#endif
