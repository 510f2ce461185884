// View-dependent curvature (Judd et al. 2007): the turn of the normal per step on the screen
// (host/lines/extraction/apparent_ridges.cpp). n is the normal, w the unit vector to the eye.
#ifndef EXEMPLAR_VIEW_CURVATURE_GLSL
#define EXEMPLAR_VIEW_CURVATURE_GLSL

const float k_grazing = 1e-3;  // min |n.w| in the foreshortening

// Returns the length on the surface of a step towards the eye that has length 1 on the screen.
float screen_step(float cosine) {
    return 1.0 / max(abs(cosine), k_grazing);
}

// Returns the maximum view-dependent curvature, squared (x), and its direction on the surface in (e1, e2) (yz), a
// step of length 1 on the screen. `k`: k1 and k2; `uv`: the components of w along e1 and e2; `cosine`: n.w.
vec3 view_curvature(vec2 k, vec2 uv, float cosine) {
    const float sine = length(uv), stretch = screen_step(cosine) - 1.0;
    const vec2 a = sine > 0.0 ? uv / sine : vec2(0.0);
    const mat2 to_surface = mat2(1.0 + stretch * a.x * a.x, stretch * a.x * a.y, stretch * a.x * a.y,
                                 1.0 + stretch * a.y * a.y);
    const mat2 to_normal = mat2(k * to_surface[0], k * to_surface[1]);
    const float xx = dot(to_normal[0], to_normal[0]), xy = dot(to_normal[0], to_normal[1]),
                yy = dot(to_normal[1], to_normal[1]);
    const float half_difference = 0.5 * (xx - yy), radius = sqrt(half_difference * half_difference + xy * xy);
    const float angle = 0.5 * (radius > 0.0 ? atan(xy, half_difference) : 0.0);
    return vec3(0.5 * (xx + yy) + radius, to_surface * vec2(cos(angle), sin(angle)));
}

// Returns the minimum view-dependent curvature, squared, given the maximum, squared, as `largest`.
float min_view_curvature(vec2 k, float largest, float cosine) {
    const float determinant = k.x * k.y * screen_step(cosine);
    return largest > 0.0 ? min(determinant / largest * determinant, largest) : 0.0;
}

#endif
