// Indices of pixels in an image and in the box that is processed.
#ifndef EXEMPLAR_IMAGE_BOX_GLSL
#define EXEMPLAR_IMAGE_BOX_GLSL
#include "shaders/shared/image_filters.h"

bool in_image(ImageParameters image, uvec2 at) { return at.x < image.width && at.y < image.height; }

uint pixel_count(ImageParameters image) { return image.width * image.height; }

uint pixel_index(ImageParameters image, uvec2 at) { return at.y * image.width + at.x; }

// Returns whether a pixel of the image is in the box; box_index then gives its index there.
bool in_box(ImageParameters image, uvec2 at) {
    return at.x >= image.box_x && at.y >= image.box_y && at.x - image.box_x < image.box_width &&
           at.y - image.box_y < image.box_height;
}

uint box_index(ImageParameters image, uvec2 at) {
    return (at.y - image.box_y) * image.box_width + at.x - image.box_x;
}

// Returns the image's pixel for an invocation of a grid over the box. The grid may be larger than the box.
uvec2 pixel_of_box(ImageParameters image, uvec2 place) { return uvec2(image.box_x, image.box_y) + place; }

#endif
