// The sum of what the invocations before this one in its workgroup have, and of all, in `group_total`. Groups are small, so
// that adding up one by one takes less than the barriers of a tree.
#ifndef EXEMPLAR_GROUP_SUM_GLSL
#define EXEMPLAR_GROUP_SUM_GLSL

shared uint group_counts[gl_WorkGroupSize.x];
uint group_total;

uint sum_before(uint count) {
    group_counts[gl_LocalInvocationID.x] = count;
    barrier();
    uint before = 0;
    group_total = 0;
    for (uint i = 0; i < gl_WorkGroupSize.x; ++i) {
        if (i == gl_LocalInvocationID.x) before = group_total;
        group_total += group_counts[i];
    }
    return before;
}

#endif
