#ifndef EXEMPLAR_SHARED_WINDOW_H
#define EXEMPLAR_SHARED_WINDOW_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// Where the interface is in clip space, and its font atlas.
struct InterfaceParameters {
    vec2 scale;  // clip = position * scale + offset
    vec2 offset;
    vec2 white;  // coordinates of a place in the atlas that is opaque
    uint atlas_width;
    uint atlas_height;
};

struct InterfaceVertex {
    float x;
    float y;
    float u;
    float v;
    uint color;  // red lowest
};

// What a surface is painted with.
const uint k_paint_plain = 0;
const uint k_paint_faces = 1;     // a color per face
const uint k_paint_mean = 2;      // curvature: (k1 + k2) / 2
const uint k_paint_gauss = 3;     // the root of |k1 k2| with the sign of k1 k2
const uint k_paint_first = 4;     // k1
const uint k_paint_second = 5;    // k2
const uint k_paint_normals = 6;
// How it is lit.
const uint k_light_smooth = 0;  // by vertex normals
const uint k_light_flat = 1;    // by the normals of faces
const uint k_light_none = 2;
const uint k_light_steps = 3;  // smooth, in three steps

struct PaintParameters {
    vec4 matrix[4];  // columns: world to clip space
    vec4 eye;        // its position and 1, or for a parallel projection the direction to it and 0
    uint paint;
    uint light;
    uint plain;             // sRGB, red lowest
    float curvature_scale;  // a curvature of its inverse has the strongest color
};

#ifdef __cplusplus
EXEMPLAR_LAYOUT(InterfaceParameters, scale, offset, white, atlas_width, atlas_height)
EXEMPLAR_LAYOUT(InterfaceVertex, x, y, u, v, color)
EXEMPLAR_LAYOUT(PaintParameters, matrix, eye, paint, light, plain, curvature_scale)
#endif

SHARED_END
#endif
