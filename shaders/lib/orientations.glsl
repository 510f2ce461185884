// The directions of strokes between pixels, and what is in their way (host/hatching/stroke_tracing.cpp).
#ifndef EXEMPLAR_ORIENTATIONS_GLSL
#define EXEMPLAR_ORIENTATIONS_GLSL
#include "shaders/lib/placement_grid.glsl"

const int k_least_agreement = 358;  // of directions that are averaged, in shares

// Whether a step from a pixel to itself or one of the eight around it is free.
bool is_free_step(ivec2 from, ivec2 to) {
    const ivec2 a = from >> k_pixel_bits, b = to >> k_pixel_bits, low = min(a, b);
    const bool along = a.x != b.x, down = a.y != b.y;
    const bool free_along_here = !along || (texel_at(ivec2(low.x, a.y)).w & k_right_barrier) == 0u;
    const bool free_along_there = !along || (texel_at(ivec2(low.x, b.y)).w & k_right_barrier) == 0u;
    const bool free_down_here = !down || (texel_at(ivec2(a.x, low.y)).w & k_lower_barrier) == 0u;
    const bool free_down_there = !down || (texel_at(ivec2(b.x, low.y)).w & k_lower_barrier) == 0u;
    return (free_along_here && free_down_there) || (free_down_here && free_along_there);
}

// Half of the angle of (c, s), of some length, that is nearer to `heading`.
ivec2 half_angle(ivec2 sum, int size, ivec2 heading) {
    const ivec2 halved = direction_of(sum.x >= 0 ? ivec2(size + sum.x, sum.y) : ivec2(sum.y, size - sum.x));
    return dot_of(halved, heading) < 0 ? -halved : halved;
}

// Adds a direction, times a weight; z is the sum of weights.
void add_direction(uvec4 texel, uint layer, bool reached, int weight, inout ivec3 sum) {
    const int word = int(direction_word(texel, layer));
    const int counted = word != 0 && reached ? weight : 0;
    sum += counted * ivec3(bitfieldExtract(word, 0, 16), bitfieldExtract(word, 16, 16), 1);
}

// The direction of a layer's strokes at a point, the one of both that is nearer to `heading`; zero if there is none.
ivec2 direction_at(uint layer, ivec2 point, ivec2 heading) {
    const ivec2 from_center = point - k_pixel / 2, corner = from_center >> k_pixel_bits;
    const ivec2 home = (point >> k_pixel_bits) - corner;
    const uvec4 t00 = texel_at(corner), t10 = texel_at(corner + ivec2(1, 0)), t01 = texel_at(corner + ivec2(0, 1)),
                t11 = texel_at(corner + ivec2(1, 1));
    const bvec2 free_along = equal(uvec2(t00.w, t01.w) & k_right_barrier, uvec2(0u));  // per row
    const bvec2 free_down = equal(uvec2(t00.w, t10.w) & k_lower_barrier, uvec2(0u));   // per column
    const bool along = home.y == 0 ? free_along.x : free_along.y, along_other = home.y == 0 ? free_along.y : free_along.x;
    const bool down = home.x == 0 ? free_down.x : free_down.y, down_other = home.x == 0 ? free_down.y : free_down.x;
    const bool across = (along && down_other) || (down && along_other);
    const bool x0 = home.x == 0, y0 = home.y == 0;

    const ivec2 high = (from_center & (k_pixel - 1)) >> 4, low = 256 - high;
    ivec3 sum = ivec3(0);
    add_direction(t00, layer, x0 ? y0 || down : y0 ? along : across, low.x * low.y, sum);
    add_direction(t10, layer, !x0 ? y0 || down : y0 ? along : across, high.x * low.y, sum);
    add_direction(t01, layer, x0 ? !y0 || down : !y0 ? along : across, low.x * high.y, sum);
    add_direction(t11, layer, !x0 ? !y0 || down : !y0 ? along : across, high.x * high.y, sum);
    const ivec2 mean = (sum.xy + (1 << 15)) >> 16;
    const int size = int(floor_sqrt(uint(dot_of(mean, mean))));
    const uvec4 own = x0 ? (y0 ? t00 : t01) : (y0 ? t10 : t11);
    const bool known = direction_word(own, layer) != 0u && size != 0 && size << 12 >= sum.z * k_least_agreement;
    return known ? half_angle(mean, size, heading) : ivec2(0);
}

#endif
