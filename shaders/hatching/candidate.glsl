// Access to the strokes tried in a round. Invocations of a workgroup process every 64th point of a stroke; if
// several workgroups share a stroke, each processes some of the rows of pixels around every point. The including
// shader declares `trials`, and `ways`, the points of all streamlines.
#ifndef EXEMPLAR_CANDIDATE_GLSL
#define EXEMPLAR_CANDIDATE_GLSL
#include "shaders/hatching/placement_grid.glsl"

// Returns the i-th point of the streamline of the trial at a place of the round's list.
ivec2 way_point(uint place, uint way_begin, uint i) {
    return ways[place * parameters.room + (way_begin + i) % parameters.room];
}

// The place of the workgroup's trial, and which rows the workgroup processes: every candidate_parts()-th.
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
