// Direction to the eye.
#ifndef EXEMPLAR_EYE_GLSL
#define EXEMPLAR_EYE_GLSL

// Returns the unit vector from a point to the eye. `eye` is its position and w = 1 or, for a parallel projection,
// the unit direction to it and w = 0.
vec3 to_eye(vec4 eye, vec3 here) {
    return normalize(eye.xyz - eye.w * here);
}

#endif
