#ifndef EXEMPLAR_SHARED_GBUFFER_H
#define EXEMPLAR_SHARED_GBUFFER_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// Parameters of rasterizing one tile of a G-buffer.
struct FaceParameters {
    vec4 matrix[4];   // columns: world to the tile's clip space
    uint first_face;  // number of the first face that is drawn
    uint unused0;
    uint unused1;
    uint unused2;
};

// Parameters of computing the points visible in a tile's pixels.
struct PointParameters {
    vec4 clip_x;  // rows of the matrix from world to the picture's clip space
    vec4 clip_y;
    vec4 clip_w;
    vec4 axis;    // row that gives the depth along the camera's axis
    uint tile_x;  // upper left pixel of the tile in the picture
    uint tile_y;
    uint tile_width;
    uint tile_height;
    uint width;  // size of the picture
    uint height;
    uint first_face;  // faces [first_face, end_face) are bound
    uint end_face;
};

const uint k_gbuffer_no_face = 0xFFFFFFFFu;  // exemplar::k_no_face

#ifdef __cplusplus
EXEMPLAR_LAYOUT(FaceParameters, matrix, first_face, unused0, unused1, unused2)
EXEMPLAR_LAYOUT(PointParameters, clip_x, clip_y, clip_w, axis, tile_x, tile_y, tile_width, tile_height, width, height,
                first_face, end_face)
#endif

SHARED_END
#endif
