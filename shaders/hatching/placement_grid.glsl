// Targets and barriers of pixels (host/hatching/placement/placement_grid.h). The including shader declares
// `parameters` and `grid`.
#ifndef EXEMPLAR_PLACEMENT_GRID_GLSL
#define EXEMPLAR_PLACEMENT_GRID_GLSL
#include "shaders/hatching/fixed_point.glsl"

ivec2 last_pixel() {
    return ivec2(parameters.width, parameters.height) - 1;
}
bool is_inside(ivec2 pixel) {
    return all(equal(pixel, clamp(pixel, ivec2(0), last_pixel())));
}
// Returns the index of a pixel, or of the nearest one in the picture.
int index_of(ivec2 pixel) {
    const ivec2 near_pixel = clamp(pixel, ivec2(0), last_pixel());
    return near_pixel.y * int(parameters.width) + near_pixel.x;
}
// Returns the directions of both layers, sizes and flags of a pixel; zero outside of the picture.
uvec4 texel_at(ivec2 pixel) {
    return mix(uvec4(0u), texelFetch(grid, index_of(pixel)), bvec4(is_inside(pixel)));
}
uvec4 texel_of(ivec2 point) {
    return texel_at(point >> k_pixel_bits);
}
// Returns the packed direction of a layer; 0 if it is not hatched.
uint direction_word(uvec4 texel, uint layer) {
    return mix(texel.y, texel.x, layer == 0u);
}
int spacing_of(uvec4 texel) {
    return int(texel.z & 0xffffu);
}
int length_of(uvec4 texel) {
    return int(texel.z >> 16);
}
int share_of_spacing(int spacing, int share) {
    return (spacing * share >> k_share_bits) << (k_pixel_bits - k_spacing_bits);
}

// The radius in which stroke points are recorded, and which points are (Clearance).
int clearance_radius(int spacing) {
    return share_of_spacing(spacing, 1280) + k_pixel;
}
bool is_recorded(uint i, uint count, int spacing) {
    return i % uint(max(1, spacing >> (k_spacing_bits + 2))) == 0u || i + 1u == count;
}

// Returns the pixels from `low` to `high`, which include all whose centers are within `reach` of a point.
void pixels_within(ivec2 point, int reach, out ivec2 low, out ivec2 high) {
    const ivec2 pixel = point >> k_pixel_bits;
    const int pixels = (reach >> k_pixel_bits) + 1;
    low = max(pixel - pixels, ivec2(0));
    high = min(pixel + pixels, last_pixel());
}
ivec2 offset_from_center(ivec2 pixel, ivec2 point) {
    return (point - pixel * k_pixel - k_pixel / 2) >> parameters.near_shift;
}

#endif
