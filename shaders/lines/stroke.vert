#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lines/texture_phase.glsl"
#include "shaders/shared/lines.h"

// Draws a quad from each point of a chain to the next, as wide as the stroke plus a pixel on each side for soft
// edges. Consecutive quads share corners, so nothing is drawn twice.
layout(push_constant) uniform Push { StrokeDrawParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer points;
layout(set = 0, binding = 1) uniform samplerBuffer strokes;
layout(set = 0, binding = 2) uniform usamplerBuffer visible;
layout(set = 0, binding = 3, std430) readonly buffer Looks { StrokeLook looks[]; };
// Binding 4 is the fragment shader's.
layout(set = 0, binding = 5, std430) readonly buffer Phases { vec2 phases[]; };

layout(set = 0, binding = 6, std430) readonly buffer Inks { vec4 inks[]; };  // red below 0: the color of the look

layout(location = 0) out vec4 along;       // pixels across, half width, opacity, share of the way to the next point
layout(location = 1) out float texture_at;  // texture coordinate along the chain, in pixels
layout(location = 2) flat out uvec3 seen;  // bits of the visible samples, number of samples, and 1 + the texture's first texel
layout(location = 3) flat out vec4 color;
layout(location = 4) flat out vec2 texture_of;  // period, and direction along the chain

// Returns what is across a stroke of unit width at an end of the piece from a point to the next. Lines along edges have
// corners, and normals half way between the directions of both sides there: they are so much longer that the stroke
// keeps its width. Where a line turns back and is hidden on the other side, the piece that is seen ends by itself.
vec2 across_at(int point, bool next) {
    const int at = next ? point + 1 : point;
    const vec2 normal = texelFetch(strokes, 2 * at + 1).xy;
    const uint kind = texelFetch(points, 2 * at + 1).x;
    if ((1u << (kind & k_kind_family) & k_edge_families) == 0u || (kind & (next ? k_point_last : k_point_first)) != 0u)
        return normal;
    const bool alone = texelFetch(visible, 2 * (next ? at : at - 1)).x == 0u;
    const vec2 on = texelFetch(strokes, 2 * point + 2).xy - texelFetch(strokes, 2 * point).xy;
    if (on == vec2(0.0)) return normal;
    const vec2 own = normalize(vec2(-on.y, on.x));
    return alone ? own : normal / max(dot(normal, own), 0.5);
}

void main() {
    const int corner = gl_VertexIndex % 6, point = gl_VertexIndex / 6;
    // Two triangles: 0 1 2, 2 1 3. Odd corners are at the next point, corners 2 and 3 on the other side.
    const int which = corner < 3 ? corner : corner == 3 ? 2 : corner == 4 ? 1 : 3;
    const bool next = (which & 1) != 0;
    const float side = which < 2 ? -1.0 : 1.0;
    const uint kind = texelFetch(points, 2 * point + 1).x;
    const StrokeLook look = looks[kind & k_kind_family];
    seen = uvec3(texelFetch(visible, 2 * point).x, texelFetch(visible, 2 * point + 1).x, look.texture);
    if ((kind & k_point_last) != 0u || seen.x == 0u) {
        gl_Position = vec4(0.0, 0.0, 0.0, 1.0);  // degenerate: draws nothing
        return;
    }
    const int at = next ? point + 1 : point;
    const vec4 stroke = texelFetch(strokes, 2 * at);  // place, width, opacity
    const float reach = 0.5 * stroke.z + 1.0;
    const vec2 pixel = stroke.xy + side * reach * across_at(point, next);
    along = vec4(side * reach, 0.5 * stroke.z, stroke.w * look.color.a, next ? 1.0 : 0.0);
    const vec2 phase = phases[point];
    const vec2 coordinates = texture_ends(phase, phases[point + 1], uintBitsToFloat(texelFetch(points, 2 * point).w),
                                          uintBitsToFloat(texelFetch(points, 2 * point + 2).w), look.period);
    texture_at = next ? coordinates.y : coordinates.x;
    const uint ink = uint(texelFetch(strokes, 2 * point + 1).z);
    color = ink > 0u && inks[ink].r >= 0.0 ? vec4(inks[ink].rgb, look.color.a) : look.color;
    // A part without lines: strokes of no width would still be a pixel of soft edge.
    if (ink > 0u && inks[ink].w <= 0.0) {
        gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
        return;
    }
    texture_of = vec2(look.period, phase.x);
    gl_Position = vec4(2.0 * pixel / vec2(parameters.width, parameters.height) - 1.0, 0.0, 1.0);
}
