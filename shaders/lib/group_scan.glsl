// Exclusive prefix sums of two numbers at once over a workgroup: exclusive_sums returns the sums of `counts` over the
// invocations before this one, and sets `group_totals` to the sums over all. For large workgroups: takes log2 of their
// size steps.
#ifndef EXEMPLAR_GROUP_SCAN_GLSL
#define EXEMPLAR_GROUP_SCAN_GLSL

shared uvec2 group_sums[2][gl_WorkGroupSize.x];  // of the steps in turns, so that a step needs one barrier
uvec2 group_totals;

uvec2 exclusive_sums(uvec2 counts) {
    const uint own = gl_LocalInvocationID.x;
    uvec2 sums = counts;
    uint turn = 0u;
    barrier();
    group_sums[0][own] = sums;
    for (uint reach = 1u; reach < gl_WorkGroupSize.x; reach *= 2u) {
        barrier();
        if (own >= reach) sums += group_sums[turn][own - reach];
        turn ^= 1u;
        group_sums[turn][own] = sums;
    }
    barrier();
    group_totals = group_sums[turn][gl_WorkGroupSize.x - 1u];
    return sums - counts;
}

#endif
