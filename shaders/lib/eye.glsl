// Where things are seen from.
#ifndef EXEMPLAR_EYE_GLSL
#define EXEMPLAR_EYE_GLSL

// The unit vector from a point to an eye: its position and 1, or for a parallel projection the unit direction to it and 0.
vec3 to_eye(vec4 eye, vec3 here) {
    return normalize(eye.xyz - eye.w * here);
}

#endif
