#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/hatching_features.h"

// Directions of fields on a surface, as the picture shows them at points of faces
// (host/hatching/features/pixel_projection.cpp). One point per invocation. Reads 112 bytes, and 48 per field; writes
// 8 per field.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { DirectionParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer corners;       // per face, a b c 0
layout(set = 0, binding = 1) uniform usamplerBuffer point_faces;
layout(set = 0, binding = 2) uniform samplerBuffer barycentrics;   // of corner 1, then of corner 2
layout(set = 0, binding = 3) uniform samplerBuffer positions;      // x y z 1
layout(set = 0, binding = 4) uniform samplerBuffer directions;     // vertices x k_slab_fields
layout(set = 0, binding = 5, std430) writeonly buffer Doubled { vec2 doubled[]; };  // fields x stride

vec3 turned(float weight, vec3 to, vec3 direction) {
    return (dot(to, direction) < 0.0 ? -weight : weight) * direction;
}

// Interpolates a direction without sign at a point: those of the corners are turned to the first that is not zero.
vec3 direction_at(ivec3 corner, vec3 weights) {
    const vec3 first = texelFetch(directions, corner.x).xyz, second = texelFetch(directions, corner.y).xyz,
               third = texelFetch(directions, corner.z).xyz;
    const vec3 leading = dot(first, first) > 0.0 ? first : second;
    return weights.x * first + turned(weights.y, leading, second) + turned(weights.z, leading, third);
}

// Returns a direction at a clip position as seen in the picture, by the derivative of the projection; of any length.
vec2 projected(vec3 at, vec3 direction) {
    const vec3 way = vec3(dot(parameters.clip_x.xyz, direction), dot(parameters.clip_y.xyz, direction),
                          dot(parameters.clip_w.xyz, direction));
    return (way.xy * at.z - at.xy * way.z) * vec2(parameters.width, parameters.height);
}

// Returns the unit vector of the doubled angle of a vector of any length; zero for zero.
vec2 doubled_angle(vec2 v) {
    const float largest = max(abs(v.x), abs(v.y));
    if (!(largest > 0.0)) return vec2(0.0);
    const vec2 unit = normalize(v / largest);
    return vec2(unit.x * unit.x - unit.y * unit.y, 2.0 * unit.x * unit.y);
}

void main() {
    const uint point = linear_thread();
    if (point >= parameters.points) return;

    const ivec3 corner = ivec3(texelFetch(corners, int(texelFetch(point_faces, int(point)).x)).xyz);
    const float b = texelFetch(barycentrics, int(point)).x,
                c = texelFetch(barycentrics, int(parameters.stride + point)).x;
    const vec3 weights = vec3(1.0 - b - c, b, c);
    const vec4 position = vec4(mat3(texelFetch(positions, corner.x).xyz, texelFetch(positions, corner.y).xyz,
                                    texelFetch(positions, corner.z).xyz) * weights, 1.0);
    const vec3 at = vec3(dot(parameters.clip_x, position), dot(parameters.clip_y, position),
                         dot(parameters.clip_w, position));
    for (uint k = 0; k < parameters.fields; ++k) {
        const vec3 direction = direction_at(int(k_slab_fields) * corner + int(k), weights);
        doubled[k * parameters.stride + point] = doubled_angle(projected(at, direction));
    }
}
