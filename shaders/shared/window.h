#ifndef EXEMPLAR_SHARED_WINDOW_H
#define EXEMPLAR_SHARED_WINDOW_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// Transform of the interface to clip space, and its font atlas.
struct InterfaceParameters {
    vec2 scale;  // clip = position * scale + offset
    vec2 offset;
    vec2 white;  // coordinates of an opaque place in the atlas
    uint atlas_width;
    uint atlas_height;
    uint picture_width;   // of the pictures, in texels; 0: the font atlas is drawn
    uint picture_height;
};

struct InterfaceVertex {
    float x;
    float y;
    float u;
    float v;
    uint color;  // red lowest
};

#ifdef __cplusplus
EXEMPLAR_LAYOUT(InterfaceParameters, scale, offset, white, atlas_width, atlas_height, picture_width, picture_height)
EXEMPLAR_LAYOUT(InterfaceVertex, x, y, u, v, color)
#endif

SHARED_END
#endif
