#ifndef EXEMPLAR_SHARED_IMAGE_FILTERS_H
#define EXEMPLAR_SHARED_IMAGE_FILTERS_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// Images with one float per pixel, one image after the other, and the box of them that is processed: planes with a
// vec4 per pixel of the box, one lane per image. Without a mask the box is the image.
struct ImageParameters {
    uint width;
    uint height;
    uint box_x;
    uint box_y;
    uint box_width;
    uint box_height;
    uint images;  // 1 to 4
    uint rows;  // of a column that an invocation of mask_box.comp reads
};

// Parameters of weighted sums along lines of pixels.
struct SumParameters {
    uint pixels;  // number of pixels in a line
    uint lines;
    uint step;       // from one pixel of a line to the next
    uint line_step;  // from one line to the next
    uint radius;     // there are 2 radius + 1 weights
    uint quads;      // number of groups of four weights, the last filled up with zeros
    float inverse_sigma;
    uint unused;
};

struct DerivativeParameters {
    ImageParameters image;
    float inverse_sigma;
    float unit_xx;  // third cumulants of x^2 / 2 and of x y, offsets in units of sigma
    float unit_xy;
    float min_spread;
};

struct OrientationParameters {
    ImageParameters image;
    float noise;  // squared gradient that counts as noise
    uint unused0;
    uint unused1;
    uint unused2;
};

const uint k_filter_images = 4;
const uint k_filter_no_face = 0xFFFFFFFFu;  // exemplar::k_no_face

#ifdef __cplusplus
EXEMPLAR_LAYOUT(ImageParameters, width, height, box_x, box_y, box_width, box_height, images, rows)
EXEMPLAR_LAYOUT(SumParameters, pixels, lines, step, line_step, radius, quads, inverse_sigma, unused)
EXEMPLAR_LAYOUT(DerivativeParameters, image, inverse_sigma, unit_xx, unit_xy, min_spread)
EXEMPLAR_LAYOUT(OrientationParameters, image, noise, unused0, unused1, unused2)
#endif

SHARED_END
#endif
