// Projects points into the picture. The including shader declares `parameters` with matrix, width and height.
#ifndef EXEMPLAR_IN_PICTURE_GLSL
#define EXEMPLAR_IN_PICTURE_GLSL

// Returns pixels to the right and down, depth, and depth along the camera's axis (not positive behind the eye).
vec4 in_picture(vec3 at) {
    const vec4 clip = parameters.matrix[0] * at.x + parameters.matrix[1] * at.y + parameters.matrix[2] * at.z +
                      parameters.matrix[3];
    const vec3 on_screen = clip.xyz / clip.w;
    return vec4((on_screen.xy * 0.5 + 0.5) * vec2(parameters.width, parameters.height), on_screen.z, clip.w);
}

#endif
