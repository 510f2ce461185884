#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/curvature/tangent.glsl"
#include "shaders/shared/curvature.h"

// Computes curvature from its components (exemplar::reproject_curvature), for k_quads x 4 vertices of a tile per
// invocation. Reads, each once, 1 byte per vertex and entry, 4 per entry, 2 per vertex and mean, and 16 each per
// normal, position and neighbor's position, and writes 48 per vertex; components, rotations and most neighbors come
// from caches. Vertices may repeat at the end of a tile; all copies get the same values.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const bool k_principal = false;  // the thesis' eight attributes, else the seven of tensors
layout(constant_id = 1) const uint k_quads = 1;          // 1, 2 or 4
layout(push_constant) uniform Push { ReprojectionParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer table;  // CurvatureTile
layout(set = 0, binding = 1) uniform usamplerBuffer tiles;
layout(set = 0, binding = 2) uniform usamplerBuffer groups;  // four entries each, of component and step
layout(set = 0, binding = 3) uniform samplerBuffer components;
layout(set = 0, binding = 4) uniform samplerBuffer rotations;  // principal: three rows per segment
layout(set = 0, binding = 5) uniform samplerBuffer vertices;   // for tensors only
layout(set = 0, binding = 6) uniform samplerBuffer normals;
layout(set = 0, binding = 7, std430) writeonly buffer First { vec4 first[]; };                 // e1, k1
layout(set = 0, binding = 8, std430) writeonly buffer Second { vec4 second[]; };               // e2, k2
layout(set = 0, binding = 9, std430) writeonly buffer Derivatives { vec4 derivatives[]; };

const uint k_constants = k_principal ? 11 : 7;  // rows: means, reference normals
const uint k_constant_pairs = (k_constants + 1) / 2;
const uint k_head = k_principal ? k_principal_head : k_tensor_head;
const float k_min_divisor = 0.2, k_min_flatness = 1e-6;  // as in host/curvature/state/attributes.h

vec4 four_halves(uvec2 words) {
    return vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y));
}

vec4 four_bytes(uint word) {
    return vec4(ivec4(int(word) << 24, int(word) << 16, int(word) << 8, int(word)) >> 24);
}

// Rows of this invocation's quads: attributes and, if principal, the reference normal.
vec4 rows[12 * k_quads];
// Position of the next reads.
uint next_texel, next_group;

void read_constants() {
    for (uint p = 0; p < k_constant_pairs; ++p, next_texel += k_tile_quads)
        for (uint q = 0; q < k_quads; ++q) {
            const uvec4 both = texelFetch(tiles, int(next_texel + q));
            rows[2 * p * k_quads + q] = four_halves(both.xy);
            rows[(2 * p + 1) * k_quads + q] = four_halves(both.zw);
        }
}

// Adds the components of one attribute. Fetches a whole group before it is used: D5 in docs/portability.md.
void add_components(uint row, uint count, float scale) {
    vec4 sum[k_quads];
    for (uint q = 0; q < k_quads; ++q) sum[q] = scale * rows[row * k_quads + q];
    for (const uint end = next_group + count; next_group < end; ++next_group, next_texel += k_tile_quads) {
        const uvec4 group = texelFetch(groups, int(next_group)), component = group & 0xffffu;
        uvec4 bases[k_quads];
        for (uint q = 0; q < k_quads; ++q) bases[q] = texelFetch(tiles, int(next_texel + q));
        const vec4 z = vec4(texelFetch(components, int(component.x)).x, texelFetch(components, int(component.y)).x,
                            texelFetch(components, int(component.z)).x, texelFetch(components, int(component.w)).x) *
                       uintBitsToFloat(group & 0xffff0000u);
        for (uint q = 0; q < k_quads; ++q)
            sum[q] += z.x * four_bytes(bases[q].x) + z.y * four_bytes(bases[q].y) + z.z * four_bytes(bases[q].z) +
                      z.w * four_bytes(bases[q].w);
    }
    for (uint q = 0; q < k_quads; ++q) rows[row * k_quads + q] = sum[q];
}

// Unrolled by hand, so that `rows` is not indexed by a variable.
void add_all_components(uvec4 counts) {
    const vec4 low = parameters.low_scales, high = parameters.high_scales;
    add_components(0, counts.x & 0xffffu, low.x);
    add_components(1, counts.x >> 16, low.y);
    add_components(2, counts.y & 0xffffu, low.z);
    add_components(3, counts.y >> 16, low.w);
    add_components(4, counts.z & 0xffffu, high.x);
    add_components(5, counts.z >> 16, high.y);
    add_components(6, counts.w & 0xffffu, high.z);
    if (k_principal) add_components(7, counts.w >> 16, high.w);
}

// Returns the unit direction of an edge in the tangent plane, or any tangent if the edge is parallel to the normal.
vec3 edge_tangent(vec3 edge, vec3 normal) {
    const vec3 flattened = edge - dot(normal, edge) * normal;
    const float squared = dot(flattened, flattened);
    return squared > k_min_flatness * dot(edge, edge) ? flattened / sqrt(squared) : frame_of_normal(normal).tangent;
}

// Completes e1 from two of its coordinates, all but the one where |reference| is largest.
vec3 completed_direction(vec2 kept, vec3 reference, vec3 normal) {
    const vec3 size = abs(reference);
    const bool drop_x = size.x >= size.y && size.x >= size.z, drop_y = !drop_x && size.y >= size.z;
    vec3 e = drop_x ? vec3(0.0, kept) : drop_y ? vec3(kept.x, 0.0, kept.y) : vec3(kept, 0.0);
    const float along = drop_x ? normal.x : drop_y ? normal.y : normal.z;
    const float missing = -dot(normal, e) / (along >= 0.0 ? max(along, k_min_divisor) : min(along, -k_min_divisor));
    e += drop_x ? vec3(missing, 0.0, 0.0) : drop_y ? vec3(0.0, missing, 0.0) : vec3(0.0, 0.0, missing);
    e -= dot(normal, e) * normal;
    const float size_of_e = length(e);
    return size_of_e > 1e-6 ? e / size_of_e : frame_of_normal(normal).tangent;
}

void store_tensor(uint vertex, uint neighbor, vec4 of_quad[11]) {
    const vec3 normal = texelFetch(normals, int(vertex)).xyz;
    const vec3 edge = texelFetch(vertices, int(neighbor)).xyz - texelFetch(vertices, int(vertex)).xyz;
    const vec3 tangent = edge_tangent(edge, normal), bitangent = cross(normal, tangent);
    vec2 k;
    const vec2 turn = principal_rotation(vec3(of_quad[0].x, of_quad[1].x, of_quad[2].x), k);
    first[vertex] = vec4(turn.x * tangent + turn.y * bitangent, k.x);
    second[vertex] = vec4(turn.x * bitangent - turn.y * tangent, k.y);
    derivatives[vertex] = in_rotated_frame(vec4(of_quad[3].x, of_quad[4].x, of_quad[5].x, of_quad[6].x), turn);
}

void store_principal(uint vertex, mat3 rotation, vec4 of_quad[11]) {
    const vec3 normal = texelFetch(normals, int(vertex)).xyz * rotation;
    const vec3 reference = vec3(of_quad[8].x, of_quad[9].x, of_quad[10].x);
    const vec3 e1 = completed_direction(vec2(of_quad[2].x, of_quad[3].x), reference, normal);
    first[vertex] = vec4(rotation * e1, max(of_quad[0].x, of_quad[1].x));
    second[vertex] = vec4(rotation * cross(normal, e1), min(of_quad[0].x, of_quad[1].x));
    derivatives[vertex] = vec4(of_quad[4].x, of_quad[5].x, of_quad[6].x, of_quad[7].x);
}

// Stores the results of a quad. `quad`: index in this invocation; `texel`: the texel of its vertices.
void store_quad(uint quad, int texel, mat3 rotation) {
    uvec4 quad_vertices = texelFetch(tiles, texel), neighbors = quad_vertices;
    if (!k_principal) neighbors = texelFetch(tiles, texel + int(k_tile_quads));
    vec4 of_quad[11];
    for (uint i = 0; i < k_constants; ++i) of_quad[i] = rows[i * k_quads + quad];
    // Vectors are rotated by swizzles instead of indexed.
    [[unroll]] for (uint v = 0; v < 4; ++v, quad_vertices = quad_vertices.yzwx, neighbors = neighbors.yzwx) {
        if (k_principal)
            store_principal(quad_vertices.x, rotation, of_quad);
        else
            store_tensor(quad_vertices.x, neighbors.x, of_quad);
        for (uint i = 0; i < k_constants; ++i) of_quad[i] = of_quad[i].yzwx;
    }
}

mat3 rotation_of(uint segment) {
    const int row = int(3 * segment);
    return transpose(mat3(texelFetch(rotations, row).xyz, texelFetch(rotations, row + 1).xyz,
                          texelFetch(rotations, row + 2).xyz));
}

void main() {
    const uint thread = linear_thread();
    const uint tile = thread / (k_tile_quads / k_quads), first_quad = thread % (k_tile_quads / k_quads) * k_quads;
    if (tile >= parameters.tiles) return;

    const uvec4 entry = texelFetch(table, int(parameters.first_tile + tile));
    const uint head = entry.x - parameters.first_texel;
    next_texel = head + k_head + first_quad;
    next_group = entry.y - parameters.first_group;
    read_constants();
    add_all_components(texelFetch(tiles, int(head)));

    mat3 rotation = mat3(1.0);
    if (k_principal) rotation = rotation_of(entry.z);
    const int quad = int(head + 1 + first_quad);
    store_quad(0, quad, rotation);
    if (k_quads > 1) store_quad(1, quad + 1, rotation);
    if (k_quads > 2) {
        store_quad(2, quad + 2, rotation);
        store_quad(3, quad + 3, rotation);
    }
}
