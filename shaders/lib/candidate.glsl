// What a workgroup has to do with that tried a stroke. The including shader declares `way_points`, the words of the points of
// all ways.
#ifndef EXEMPLAR_CANDIDATE_GLSL
#define EXEMPLAR_CANDIDATE_GLSL
#include "shaders/lib/placement_grid.glsl"

// The i-th point of the way of the trial at a place of the round's list.
ivec2 way_point(uint place, uint way_begin, uint i) {
    const int at = int(2u * (place * parameters.room + (way_begin + i) % parameters.room));
    return ivec2(texelFetch(way_points, at).x, texelFetch(way_points, at + 1).x);
}

#endif
