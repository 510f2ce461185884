// Light on surfaces that have two sides (exemplar::RenderOptions).
#ifndef EXEMPLAR_LIGHT_GLSL
#define EXEMPLAR_LIGHT_GLSL

// Normals that cancel out are left without direction, not made NaN.
vec3 unit_normal(vec3 normal) {
    return normal * inversesqrt(max(dot(normal, normal), 1e-30));
}

// Hemisphere light and headlight, that linear colors are multiplied by.
float reference_light(vec3 unit_normal, vec3 to_eye, float ambient, float ground, float headlight) {
    const float facing = dot(unit_normal, to_eye);
    const float up = facing < 0.0 ? -unit_normal.y : unit_normal.y;
    return ambient * mix(ground, 1.0, (1.0 + up) / 2.0) + headlight * abs(facing);
}

#endif
