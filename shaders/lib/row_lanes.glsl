// Long sums, one for each row of a table. On CPU drivers an invocation adds a whole row. On cards a workgroup does, as a
// row alone is a long chain of loads and there are few rows: each invocation adds every k_row_lanes-th item.
// The host dispatches as many invocations as row_threads() of gpu/curvature/learned/row_threads.h returns.
//   row_index()   the row of this invocation
//   first_item()  its first item; the next are k_row_lanes apart
//   row_total(v)  the sum of v over the row's invocations, in a fixed order; all of the workgroup call it
#ifndef EXEMPLAR_ROW_LANES_GLSL
#define EXEMPLAR_ROW_LANES_GLSL
#include "shaders/lib/dispatch.glsl"

#ifdef EXEMPLAR_CPU
layout(local_size_x = 64, local_size_x_id = 100) in;
const uint k_row_lanes = 1;
uint row_index() { return linear_group() * gl_WorkGroupSize.x + gl_LocalInvocationID.x; }
uint first_item() { return 0; }
vec4 row_total(vec4 sum) { return sum; }
#else
const uint k_row_lanes = k_row_group;
layout(local_size_x = k_row_group) in;
shared vec4 row_sums[k_row_group];
uint row_index() { return linear_group(); }
uint first_item() { return gl_LocalInvocationID.x; }
vec4 row_total(vec4 sum) {
    const uint own = gl_LocalInvocationID.x;
    barrier();
    row_sums[own] = sum;
    barrier();
    for (uint reach = k_row_group / 2; reach > 0; reach /= 2) {
        if (own < reach) row_sums[own] += row_sums[own + reach];
        barrier();
    }
    return row_sums[0];
}
#endif

#endif
