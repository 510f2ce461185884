// The sRGB transfer functions (IEC 61966-2-1) of values in [0, 1]; host/imaging/raster.h has the same.
#ifndef EXEMPLAR_SRGB_GLSL
#define EXEMPLAR_SRGB_GLSL

vec3 srgb_to_linear(vec3 encoded) {
    return mix(pow((encoded + 0.055) / 1.055, vec3(2.4)), encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}

vec3 linear_to_srgb(vec3 linear) {
    return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, linear * 12.92, lessThanEqual(linear, vec3(0.0031308)));
}

#endif
