// Exclusive prefix sum over a small workgroup: exclusive_sum returns the sum of `count` over the invocations before
// this one, and sets `group_total` to the sum over all. Adds in rows of eight, then the rows: D7 in
// docs/portability.md.
#ifndef EXEMPLAR_GROUP_SUM_GLSL
#define EXEMPLAR_GROUP_SUM_GLSL

const uint k_sum_row = 8;
shared uint group_counts[gl_WorkGroupSize.x];
shared uint row_counts[gl_WorkGroupSize.x / k_sum_row];
uint group_total;

uint exclusive_sum(uint count) {
    const uint own = gl_LocalInvocationID.x, row = own / k_sum_row, place = own % k_sum_row;
    group_counts[own] = count;
    barrier();
    uint before = 0, of_row = 0;
    for (uint i = 0; i < k_sum_row; ++i) {
        if (i == place) before = of_row;
        of_row += group_counts[row * k_sum_row + i];
    }
    if (place == 0) row_counts[row] = of_row;
    barrier();
    group_total = 0;
    for (uint i = 0; i < gl_WorkGroupSize.x / k_sum_row; ++i) {
        if (i == row) before += group_total;
        group_total += row_counts[i];
    }
    return before;
}

#endif
