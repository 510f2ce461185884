#ifndef EXEMPLAR_SHARED_PAINT_H
#define EXEMPLAR_SHARED_PAINT_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// Paint of a surface: specialization constant 0 of shaders/imaging/surface.
const uint k_paint_plain = 0;
const uint k_paint_faces = 1;   // a color per face
const uint k_paint_mean = 2;    // curvature: (k1 + k2) / 2
const uint k_paint_gauss = 3;   // square root of |k1 k2| with the sign of k1 k2
const uint k_paint_first = 4;   // k1
const uint k_paint_second = 5;  // k2
const uint k_paint_normals = 6;
const uint k_paints = 7;
// Light on a surface: specialization constant 1.
const uint k_light_smooth = 0;  // by vertex normals
const uint k_light_flat = 1;    // by the normals of faces
const uint k_light_none = 2;
const uint k_light_steps = 3;      // headlight in three steps
const uint k_light_headlight = 4;  // from the eye
const uint k_lights = 5;

struct PaintParameters {
    vec4 matrix[4];         // columns: world to clip space
    vec4 eye;               // its position and 1; for a parallel projection the unit direction to it and 0
    vec4 plain;             // sRGB color, and the opacity of the whole surface
    float curvature_scale;  // 1 / the curvature with the strongest color
    uint unused0;
    uint unused1;
    uint unused2;
};

#ifdef __cplusplus
EXEMPLAR_LAYOUT(PaintParameters, matrix, eye, plain, curvature_scale, unused0, unused1, unused2)
#endif

SHARED_END
#endif
