// The clearance map of placed strokes (host/hatching/placement/clearance.h). The including shader declares `near`,
// the words of both layers.
#ifndef EXEMPLAR_CLEARANCE_GLSL
#define EXEMPLAR_CLEARANCE_GLSL
#include "shaders/hatching/placement_grid.glsl"

const uint k_far = 0xffffffffu;

uint squared_distance(ivec2 pixel, int first, ivec2 point) {
    const uint word = texelFetch(near, first + index_of(pixel)).x;
    const ivec2 way = ivec2(word >> 11 & 2047u, word & 2047u) - 1024 - offset_from_center(pixel, point);
    return mix(k_far, uint(dot_of(way, way)), all(bvec2(word != k_far, is_inside(pixel))));
}

// Returns the squared distance from a point to the nearest of the points recorded at the four pixels around it, in
// squared units of 2^near_shift; k_far if there are none.
uint squared_distance(uint layer, ivec2 point) {
    const int first = int(layer * parameters.width * parameters.height);
    const ivec2 corner = (point - k_pixel / 2) >> k_pixel_bits;
    return min(min(squared_distance(corner, first, point), squared_distance(corner + ivec2(1, 0), first, point)),
               min(squared_distance(corner + ivec2(0, 1), first, point),
                   squared_distance(corner + ivec2(1, 1), first, point)));
}

// Returns whether a point is at least `share` of `spacing` away from all strokes of its layer.
bool is_clear(uint layer, ivec2 point, int spacing, int share) {
    const uint least = uint(share_of_spacing(spacing, share) >> parameters.near_shift);
    return squared_distance(layer, point) >= least * least;
}

#endif
