#ifndef EXEMPLAR_SHARED_RENDER_H
#define EXEMPLAR_SHARED_RENDER_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// Parameters of drawing one tile of a picture; the light is that of exemplar::RenderOptions.
struct RenderParameters {
    vec4 matrix[4];  // columns: world to the tile's clip space
    vec4 eye;        // its position and 1; for a parallel projection the direction to it and 0
    float ambient;
    float ground;
    float headlight;
    uint vertex_normals;  // 1: a normal per vertex, 0: a normal per face
};

struct ResolveParameters {
    uint width;  // size of the tile, in pixels
    uint height;
};

// Samples per pixel and axis, at the centers of a regular grid.
const uint k_render_samples = 2;

#ifdef __cplusplus
EXEMPLAR_LAYOUT(RenderParameters, matrix, eye, ambient, ground, headlight, vertex_normals)
EXEMPLAR_LAYOUT(ResolveParameters, width, height)
#endif

SHARED_END
#endif
