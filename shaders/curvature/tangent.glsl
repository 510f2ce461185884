// Second fundamental forms and their derivatives in tangent frames; the counterpart of
// host/mesh/curvature/curvature.cpp.
#ifndef EXEMPLAR_TANGENT_GLSL
#define EXEMPLAR_TANGENT_GLSL

struct TangentFrame {
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
};

// Returns a frame with the unit normal n, without branches except for a sign (Duff et al. 2017).
TangentFrame frame_of_normal(vec3 n) {
    const float side = n.z < 0.0 ? -1.0 : 1.0;
    const float a = -1.0 / (side + n.z), b = n.x * n.y * a;
    return TangentFrame(vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x), vec3(b, side + n.y * n.y * a, -n.y), n);
}

// Returns frame_of_normal(n) as a spinor, two complex numbers, not normalized: the image of the first basis spinor under
// its rotation. The minimal rotation between two normals rotates frames by twice the argument of the product of
// their spinors.
vec4 spinor_of_frame(vec3 n) {
    const float a = 1.0 + abs(n.z);
    return n.z < 0.0 ? vec4(n.y, n.x, 0.0, a) : vec4(a, 0.0, n.x, n.y);
}

// Returns rotation_to(frame_of_normal(m), frame_of_normal(n).tangent, n), given the spinors of m and n, in half the operations. Zero
// for opposite normals.
vec2 turn_between(vec4 m, vec4 n) {
    const vec2 half_turn = vec2(dot(n, m), dot(n, vec4(m.y, -m.x, m.w, -m.z)));
    const vec2 squares = half_turn * half_turn;
    return vec2(squares.x - squares.y, 2.0 * half_turn.x * half_turn.y) / max(squares.x + squares.y, 1e-20);
}

// Returns the rotation (cosine and sine) from `frame` to a frame with this first axis and normal, after the minimal
// rotation that aligns the normals.
vec2 rotation_to(TangentFrame frame, vec3 axis, vec3 normal) {
    const float one_plus = 1.0 + dot(frame.normal, normal);
    // Opposite normals have no unique minimal rotation; the axis is then used as it is.
    const float tilt = one_plus > 1e-6 ? dot(frame.normal, axis) / one_plus : 0.0;
    return vec2(dot(frame.tangent, axis) - dot(frame.tangent, normal) * tilt,
                dot(frame.bitangent, axis) - dot(frame.bitangent, normal) * tilt);
}

// Returns the form (II11, II12, II22) in a frame rotated by `turn` from its own.
vec3 in_rotated_frame(vec3 form, vec2 turn) {
    const float cc = turn.x * turn.x, cs = turn.x * turn.y, ss = turn.y * turn.y;
    return vec3(cc * form.x + 2.0 * cs * form.y + ss * form.z, cs * (form.z - form.x) + (cc - ss) * form.y,
                ss * form.x - 2.0 * cs * form.y + cc * form.z);
}

// Returns the derivative (C111, C112, C122, C222) in that frame.
vec4 in_rotated_frame(vec4 d, vec2 turn) {
    const float c = turn.x, s = turn.y;
    const float ccc = c * c * c, ccs = c * c * s, css = c * s * s, sss = s * s * s;
    return vec4(ccc * d.x + 3.0 * ccs * d.y + 3.0 * css * d.z + sss * d.w,
                -ccs * d.x + (ccc - 2.0 * css) * d.y + (2.0 * ccs - sss) * d.z + css * d.w,
                css * d.x + (sss - 2.0 * ccs) * d.y + (ccc - 2.0 * css) * d.z + ccs * d.w,
                -sss * d.x + 3.0 * css * d.y - 3.0 * ccs * d.z + ccc * d.w);
}

// Conversions of tensors to irreducible components and back: two pairs per vector, each of which rotates by an
// integer multiple of the frame's angle. Forms: (mean, 0) by 0 and (half the difference of the diagonal,
// off-diagonal) by 2; derivatives by 1 and 3.
vec4 to_angular_components(vec3 form) {
    return vec4(0.5 * (form.x + form.z), 0.0, 0.5 * (form.x - form.z), form.y);
}
vec3 form_of_angular_components(vec4 s) {
    return vec3(s.x + s.z, s.w, s.x - s.z);
}
vec4 to_angular_components(vec4 d) {
    return vec4(d.x + d.z, d.y + d.w, d.x - 3.0 * d.z, 3.0 * d.y - d.w);
}
vec4 derivative_of_angular_components(vec4 s) {
    return 0.25 * vec4(3.0 * s.x + s.z, s.y + s.w, s.x - s.z, 3.0 * s.y - s.w);
}

// Returns the rotation to the principal frame of a form, in which it is diagonal with the larger value, k.x, first.
vec2 principal_rotation(vec3 form, out vec2 k) {
    const float half_difference = 0.5 * (form.x - form.z), mean = 0.5 * (form.x + form.z);
    const float radius = sqrt(half_difference * half_difference + form.y * form.y);
    k = vec2(mean + radius, mean - radius);
    if (!(radius > 0.0)) return vec2(1.0, 0.0);
    // Half the angle of (half_difference, form.y), by the one of two formulas that does not cancel.
    const float larger = sqrt(0.5 * (1.0 + abs(half_difference) / radius)), smaller = form.y / (2.0 * radius * larger);
    return half_difference >= 0.0 ? vec2(larger, smaller) : vec2(smaller, larger);
}

#endif
