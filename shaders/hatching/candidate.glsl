// What workgroups do with a stroke that is tried: invocations take every 64th of its points and, where several workgroups share
// a stroke, some of the rows of pixels around it. The including shader declares `trials`, and `ways`, the points of all.
#ifndef EXEMPLAR_CANDIDATE_GLSL
#define EXEMPLAR_CANDIDATE_GLSL
#include "shaders/hatching/placement_grid.glsl"

// The i-th point of the way of the trial at a place of the round's list.
ivec2 way_point(uint place, uint way_begin, uint i) {
    return ways[place * parameters.room + (way_begin + i) % parameters.room];
}

// The place of the workgroup's candidate, and which rows it does: every candidate_parts()-th.
uint candidate_place() {
    return trials[gl_WorkGroupID.x].listed;
}
int candidate_part() {
    return int(gl_WorkGroupID.y);
}
int candidate_parts() {
    return int(gl_NumWorkGroups.y);
}

#endif
