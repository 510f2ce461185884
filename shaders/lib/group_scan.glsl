// Exclusive prefix sum over a workgroup: exclusive_sum returns the sum of `count` over the invocations before this one,
// and sets `group_total` to the sum over all. For large workgroups: takes log2 of their size steps.
#ifndef EXEMPLAR_GROUP_SCAN_GLSL
#define EXEMPLAR_GROUP_SCAN_GLSL

shared uint group_sums[gl_WorkGroupSize.x];
uint group_total;

uint exclusive_sum(uint count) {
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
