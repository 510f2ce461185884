#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/gbuffer.h"

// Computes the point where the ray through each pixel's center meets the plane of its face. On the ray two
// homogeneous functions are zero, (clip.x - ndc.x clip.w) and (clip.y - ndc.y clip.w). They are linear in the
// barycentric coordinates, which follow from their values at the first corner and along two edges. Edges are
// differences of positions, which are precise even for tiny faces far from the origin.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { PointParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer positions;                                 // x, y, z, 1
layout(set = 0, binding = 1) uniform usamplerBuffer faces;                                    // a, b, c, 0
layout(set = 0, binding = 2, std430) readonly buffer Numbers { uint numbers[]; };             // of the tile; 0: no
                                                                                              // face
layout(set = 0, binding = 3, std430) writeonly buffer Seen { uint seen[]; };                  // pixels
layout(set = 0, binding = 4, std430) writeonly buffer Barycentrics { float barycentrics[]; }; // of corner 1, of corner 2
layout(set = 0, binding = 5, std430) writeonly buffer Depths { float depths[]; };

// The linear parts of the two functions.
vec2 along(vec2 ndc, vec3 direction) {
    const float w = dot(parameters.clip_w.xyz, direction);
    return vec2(dot(parameters.clip_x.xyz, direction) - ndc.x * w, dot(parameters.clip_y.xyz, direction) - ndc.y * w);
}

float cross_2d(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// Returns the coordinates of corners 1 and 2, clamped to the face.
vec2 barycentric(vec2 ndc, vec3 corner, vec3 edge1, vec3 edge2) {
    const vec2 constants = vec2(parameters.clip_x.w, parameters.clip_y.w) - ndc * parameters.clip_w.w;
    vec2 at = along(ndc, corner) + constants, first = along(ndc, edge1), second = along(ndc, edge2);
    const float largest = max(max(abs(first.x), abs(first.y)), max(abs(second.x), abs(second.y)));
    const float scale = largest > 0.0 ? 1.0 / largest : 0.0;  // else products would underflow for tiny units
    at *= scale;
    first *= scale;
    second *= scale;
    const float area = cross_2d(first, second);
    if (abs(area) < 1e-30) return vec2(1.0 / 3.0);  // seen edge-on
    const vec2 b = vec2(cross_2d(second, at), cross_2d(at, first)) / area;
    const vec3 inside = max(vec3(1.0 - b.x - b.y, b), vec3(0.0));
    return inside.yz / (inside.x + inside.y + inside.z);
}

void main() {
    const uvec2 place = gl_GlobalInvocationID.xy;
    if (place.x >= parameters.tile_width || place.y >= parameters.tile_height) return;
    const uvec2 at = place + uvec2(parameters.tile_x, parameters.tile_y);
    const uint pixel = at.y * parameters.width + at.x, pixels = parameters.width * parameters.height;
    const uint face = numbers[place.y * parameters.tile_width + place.x] - 1;
    vec2 b = vec2(0.0);
    float depth = uintBitsToFloat(0x7F800000u);
    if (face != k_gbuffer_no_face) {
        if (face < parameters.first_face || face >= parameters.end_face) return;
        const uvec4 corners = texelFetch(faces, int(face - parameters.first_face));
        const vec3 corner = texelFetch(positions, int(corners.x)).xyz;
        const vec3 edge1 = texelFetch(positions, int(corners.y)).xyz - corner;
        const vec3 edge2 = texelFetch(positions, int(corners.z)).xyz - corner;
        const vec2 ndc = vec2(2 * at + 1) / vec2(parameters.width, parameters.height) - 1.0;
        b = barycentric(ndc, corner, edge1, edge2);
        depth = dot(parameters.axis, vec4(corner + b.x * edge1 + b.y * edge2, 1.0));
    }
    seen[pixel] = face;
    barycentrics[pixel] = b.x;
    barycentrics[pixels + pixel] = b.y;
    depths[pixel] = depth;
}
