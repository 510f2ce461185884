// Light on two-sided surfaces (exemplar::RenderOptions).
#ifndef EXEMPLAR_LIGHT_GLSL
#define EXEMPLAR_LIGHT_GLSL

// Normalizes a normal; one that cancelled out to zero stays zero instead of becoming NaN.
vec3 unit_normal(vec3 normal) {
    return normal * inversesqrt(max(dot(normal, normal), 1e-30));
}

// Returns the hemisphere light plus headlight, a factor for linear colors.
float reference_light(vec3 unit_normal, vec3 to_eye, float ambient, float ground, float headlight) {
    const float facing = dot(unit_normal, to_eye);
    const float up = facing < 0.0 ? -unit_normal.y : unit_normal.y;
    return ambient * mix(ground, 1.0, (1.0 + up) / 2.0) + headlight * abs(facing);
}

#endif
