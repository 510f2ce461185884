// Curvature of the surface at the points of chains (host/lines/strokes/strokes.cpp). The including shader declares
// `positions`, `first`, `second` and StrokeParameters `parameters`.
#ifndef EXEMPLAR_STROKE_POINTS_GLSL
#define EXEMPLAR_STROKE_POINTS_GLSL
#include "shaders/lib/eye.glsl"
#include "shaders/shared/lines.h"

// Returns radial curvature at a vertex, times the feature size.
float radial_curvature(int vertex) {
    const vec3 w = to_eye(parameters.eye, texelFetch(positions, vertex).xyz);
    const vec4 e1 = texelFetch(first, vertex), e2 = texelFetch(second, vertex);
    const float u = dot(e1.xyz, w), v = dot(e2.xyz, w), squared = u * u + v * v;
    return parameters.feature_size * (squared > 0.0 ? (e1.w * u * u + e2.w * v * v) / squared : 0.5 * (e1.w + e2.w));
}

#endif
