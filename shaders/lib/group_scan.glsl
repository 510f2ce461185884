// The sum of what the invocations before this one in its workgroup have, and of all, in `group_total`: for large groups, in as
// many steps as their size has bits.
#ifndef EXEMPLAR_GROUP_SCAN_GLSL
#define EXEMPLAR_GROUP_SCAN_GLSL

shared uint group_sums[gl_WorkGroupSize.x];
uint group_total;

uint sum_before(uint count) {
    const uint own = gl_LocalInvocationID.x;
    barrier();
    group_sums[own] = count;
    for (uint reach = 1u; reach < gl_WorkGroupSize.x; reach *= 2u) {
        barrier();
        const uint before = own < reach ? 0u : group_sums[own - reach];
        barrier();
        group_sums[own] += before;
    }
    barrier();
    group_total = group_sums[gl_WorkGroupSize.x - 1u];
    return group_sums[own] - count;
}

#endif
