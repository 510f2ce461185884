// Least-squares fits in a face (Rusinkiewicz 2004), seen from one of its corners; a and b are the others, in order.
// The normal equations of the reference square the condition number of slivers, too much for single precision, so
// the fits are solved in closed form. The matrix M that the changes along two edges determine is exact along all
// three. The result is the symmetric tensor S that minimizes |(S - M) E|, where E has the three edges as columns; G
// = E E^T.
#ifndef EXEMPLAR_FACE_FIT_GLSL
#define EXEMPLAR_FACE_FIT_GLSL
#include "shaders/curvature/tangent.glsl"

struct FaceFit {
    TangentFrame frame;  // its tangent points to a
    float to_a;          // the edge to a is (to_a, 0) in the frame
    vec2 to_b;           // the edge to b in the frame
    float area;          // of the part of the face nearest to the corner; zero for a degenerate face
};

// Faces lower than this share of their longest edge are ignored: in single precision they are noise.
const float k_min_height = 1e-6;

// Returns the normal times twice the area, from the edges to a, to b, and from a to b. The product of the two long
// edges of a sliver would lose digits, so one factor is always the shortest or second shortest edge.
vec3 area_vector(vec3 a, vec3 b, vec3 ab) {
    return dot(a, a) < dot(b, b) ? cross(a, ab) : cross(b, ab);
}

// Returns the area of a face nearest to a corner (Meyer et al. 2003), or zero for a degenerate face. If an angle is
// obtuse, the Voronoi cells are cut off at the opposite edge.
float corner_area(vec3 a, vec3 b, vec3 ab, float twice_area) {
    const float aa = dot(a, a), bb = dot(b, b);
    if (!(twice_area > k_min_height * max(max(aa, bb), dot(ab, ab)))) return 0.0;
    const float at_corner = dot(a, b), at_a = -dot(a, ab), at_b = dot(b, ab);
    const float quarter = 0.125 * twice_area;
    if (at_corner <= 0.0) return 4.0 * quarter - quarter * (aa / at_a + bb / at_b);
    if (at_a <= 0.0) return quarter * aa / at_corner;
    if (at_b <= 0.0) return quarter * bb / at_corner;
    return 0.125 * (bb * at_a + aa * at_b) / twice_area;
}

// Measures a face. If the area is zero, nothing else may be used.
FaceFit measure_face(vec3 a, vec3 b, vec3 ab) {
    FaceFit fit;
    const vec3 n = area_vector(a, b, ab);
    const float twice_area = length(n);
    fit.area = corner_area(a, b, ab, twice_area);
    fit.to_a = length(a);
    fit.frame.tangent = a / fit.to_a;
    fit.frame.normal = n / twice_area;
    fit.frame.bitangent = cross(fit.frame.normal, fit.frame.tangent);
    fit.to_b = vec2(dot(b, fit.frame.tangent), twice_area / fit.to_a);
    return fit;
}

// Returns G as (G11, G12, G22).
vec3 edge_products(FaceFit fit) {
    const float l = fit.to_a, x = fit.to_b.x, h = fit.to_b.y;
    return vec3(l * l + x * x + (x - l) * (x - l), h * (2.0 * x - l), 2.0 * h * h);
}

// Returns the second fundamental form of a face from the changes of the normal to a and to b.
vec3 fit_form(FaceFit fit, vec3 change_a, vec3 change_b) {
    const vec2 a = vec2(dot(fit.frame.tangent, change_a), dot(fit.frame.bitangent, change_a));
    const vec2 b = vec2(dot(fit.frame.tangent, change_b), dot(fit.frame.bitangent, change_b));
    const vec2 m1 = a / fit.to_a, m2 = (b - fit.to_b.x * m1) / fit.to_b.y;
    const vec3 g = edge_products(fit) / (fit.to_a * fit.to_a);
    const float trace = g.x + g.z, skew = (m2.x - m1.y) * g.y / trace;
    return vec3(m1.x + skew, (g.x * m1.y + g.z * m2.x) / trace, m2.y - skew);
}

// Returns the derivative of the form from the changes of the forms, given in the face's frame, to a and to b.
vec4 fit_derivative(FaceFit fit, vec3 change_a, vec3 change_b) {
    const vec3 m1 = change_a / fit.to_a, m2 = (change_b - fit.to_b.x * m1) / fit.to_b.y;
    const vec3 g = edge_products(fit) / (fit.to_a * fit.to_a);
    // alpha, beta: asymmetry of M in its first two indices. second, third: C112 - m1.y and C122 - m1.z, the two
    // unknowns left after elimination of C111 and C222.
    const float alpha = m2.x - m1.y, beta = m2.y - m1.z;
    const float h = fit.to_b.y / fit.to_a, determinant = 3.0 * h * h;
    const float a = determinant / g.x, b = determinant / g.z;
    const float second = (a * alpha * (2.0 * g.z + b) + 2.0 * g.y * b * beta) /
                         (4.0 * determinant + 2.0 * g.x * b + 2.0 * g.z * a + a * b);
    const float third = 2.0 * (g.z * beta - g.y * second) / (2.0 * g.z + b);
    return vec4(m1.x - g.y / g.x * (second - alpha), m1.y + second, m1.z + third, m2.z - g.y / g.z * third);
}

#endif
