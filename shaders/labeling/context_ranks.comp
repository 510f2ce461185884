#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/tables.glsl"
#include "shaders/shared/context.h"

// Turns contextual histograms into what stumps compare: the rank of each value among the thresholds of its column, as
// write_ranks (gpu/learn/stump_scorer.h) has it. Four rows (x) of one column (y) per invocation: 16 bytes read and 4
// written.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { RankParameters parameters; };
layout(set = 0, binding = 0, std430) readonly buffer Geodesic { vec4 geodesic[]; };  // columns x rows
layout(set = 0, binding = 1, std430) readonly buffer Axes { vec4 axes[]; };          // the same
layout(set = 0, binding = 2) uvec4_table(Columns, columns);                         // RankedColumn
// The thresholds of each column, padded with the largest float to groups of four. A texel buffer also on cards, as some
// devices allow only four storage buffers.
layout(set = 0, binding = 3) uniform samplerBuffer thresholds;
layout(set = 0, binding = 4, std430) writeonly buffer Ranks { uint ranks[]; };      // columns x rows, a byte each

const uint k_lowest_rank = 128;  // so that bytes are in order as signed numbers

vec4 values_of(uint column, uint quad, uint quads) {
    if (column < parameters.geodesic_count) return geodesic[column * quads + quad];
    return axes[(column - parameters.geodesic_count) * quads + quad];
}

void main() {
    const uint quad = gl_GlobalInvocationID.x, quads = parameters.rows / 4;
    if (quad >= quads) return;
    const uvec4 entry = table_entry(columns, gl_GlobalInvocationID.y);
    const RankedColumn column = RankedColumn(entry.x, entry.y, entry.z, entry.w);
    const vec4 values = values_of(column.source, quad, quads);
    uvec4 rank = uvec4(k_lowest_rank);
    for (uint i = 0; i < column.groups; ++i) {
        const vec4 four = texelFetch(thresholds, int(column.first + i));
        for (uint k = 0; k < 4; ++k) rank += uvec4(greaterThan(values, vec4(four[k])));
    }
    rank &= 255u;  // a byte wraps around
    ranks[column.target * quads + quad] = rank.x | rank.y << 8 | rank.z << 16 | rank.w << 24;
}
