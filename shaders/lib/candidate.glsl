// What workgroups do with a stroke that is tried: each takes some of its points, its invocations some of the pixels around
// them. The including shader declares `trials`, and `way_points`, the words of the points of all ways.
#ifndef EXEMPLAR_CANDIDATE_GLSL
#define EXEMPLAR_CANDIDATE_GLSL
#include "shaders/lib/placement_grid.glsl"

// The i-th point of the way of the trial at a place of the round's list.
ivec2 way_point(uint place, uint way_begin, uint i) {
    const int at = int(2u * (place * parameters.room + (way_begin + i) % parameters.room));
    return ivec2(texelFetch(way_points, at).x, texelFetch(way_points, at + 1).x);
}

// The place of the workgroup's candidate, and which of its parts it does.
uint candidate_place() {
    return trials[linear_group() / parameters.parts].listed;
}
uint candidate_part() {
    return linear_group() % parameters.parts;
}

// The invocation's own of the pixels from `low` to `high` are every eighth of a row and of a column.
const int k_tile = 8;
ivec2 in_tile() {
    return ivec2(gl_LocalInvocationID.x % k_tile, gl_LocalInvocationID.x / k_tile);
}

#endif
