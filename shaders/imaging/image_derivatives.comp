#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/imaging/image_box.glsl"

// Computes values, gradients and curvatures of up to four images (exemplar::ImageDerivatives) from Gaussian-weighted
// sums over the pixels of the mask: sums of the images, and of the mask itself. Offsets are in units of sigma.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { DerivativeParameters parameters; };
// Sums of the images' values times x^i y^j.
layout(set = 0, binding = 0) uniform samplerBuffer sums00;
layout(set = 0, binding = 1) uniform samplerBuffer sums10;
layout(set = 0, binding = 2) uniform samplerBuffer sums01;
layout(set = 0, binding = 3) uniform samplerBuffer sums20;
layout(set = 0, binding = 4) uniform samplerBuffer sums11;
layout(set = 0, binding = 5) uniform samplerBuffer sums02;
// Sums over the mask of x^i y^j: lane i of buffer mask[j].
layout(set = 0, binding = 6) uniform samplerBuffer mask0;
layout(set = 0, binding = 7) uniform samplerBuffer mask1;
layout(set = 0, binding = 8) uniform samplerBuffer mask2;
layout(set = 0, binding = 9) uniform samplerBuffer mask3;
layout(set = 0, binding = 10) uniform usamplerBuffer faces;
// Per pixel of the image, one image after the other.
layout(set = 0, binding = 11, std430) writeonly buffer Values { float values[]; };
layout(set = 0, binding = 12, std430) writeonly buffer Gradients { float gradients[]; };    // all x, all y
layout(set = 0, binding = 13, std430) writeonly buffer Magnitudes { float magnitudes[]; };
layout(set = 0, binding = 14, std430) writeonly buffer Curvatures { float curvatures[]; };  // all maxima, all minima

// Weighted means around a pixel of quantities f, one per lane, and of their products with the offsets x and y.
struct Means {
    vec4 f, fx, fy, fxx, fxy, fyy;
};

// The means of x, y and their products, over the mask.
struct Offsets {
    float x, y, xx, xy, yy;
};

struct Hessian {
    vec4 xx, xy, yy;
};

struct Derivatives {
    vec4 value, gradient_x, gradient_y, largest, least;
};

// Returns the joint third cumulants (f, x, x), (f, x, y), (f, y, y).
Hessian third_cumulants(Means m, Offsets o) {
    return Hessian(m.fxx - 2.0 * m.fx * o.x - m.f * o.xx + 2.0 * m.f * o.x * o.x,
                   m.fxy - m.fx * o.y - m.fy * o.x - m.f * o.xy + 2.0 * m.f * o.x * o.y,
                   m.fyy - 2.0 * m.fy * o.y - m.f * o.yy + 2.0 * m.f * o.y * o.y);
}

// Returns the third cumulants of f = x in the first lane and of f = y in the second.
Hessian offset_cumulants(vec4 m0, vec4 m1, vec4 m2, vec4 m3, Offsets o) {
    Means m;
    m.f = vec4(o.x, o.y, 0.0, 0.0);
    m.fx = vec4(o.xx, o.xy, 0.0, 0.0);
    m.fy = vec4(o.xy, o.yy, 0.0, 0.0);
    m.fxx = vec4(m0.w, m1.z, 0.0, 0.0);
    m.fxy = vec4(m1.z, m2.y, 0.0, 0.0);
    m.fyy = vec4(m2.y, m3.x, 0.0, 0.0);
    return third_cumulants(m, o);
}

// Returns the inverse of an eigenvalue of the spread; fades to zero if there is too little spread for a slope.
float inverse_spread(float spread) {
    const float squared = spread * spread, least = parameters.min_spread * parameters.min_spread;
    return squared * spread / (squared * squared + least * least);
}

// Computes the slope of the least-squares line: the inverse of the spread of offsets times their covariance with f.
void slope(Means m, Offsets o, out vec4 x, out vec4 y) {
    const vec4 cx = m.fx - m.f * o.x, cy = m.fy - m.f * o.y;
    const float xx = o.xx - o.x * o.x, xy = o.xy - o.x * o.y, yy = o.yy - o.y * o.y;
    const float half_difference = 0.5 * (xx - yy), reach = sqrt(half_difference * half_difference + xy * xy);
    const float first = inverse_spread(0.5 * (xx + yy) + reach), second = inverse_spread(max(0.5 * (xx + yy) - reach, 0.0));
    const float both = 0.5 * (first + second), turn = reach > 0.0 ? 0.5 * (first - second) / reach : 0.0;
    x = (both + turn * half_difference) * cx + turn * xy * cy;
    y = turn * xy * cx + (both - turn * half_difference) * cy;
}

Derivatives derive(int place) {
    const vec4 m0 = texelFetch(mask0, place);
    const float total = 1.0 / m0.x;
    const vec4 n0 = total * m0, n1 = total * texelFetch(mask1, place), n2 = total * texelFetch(mask2, place),
               n3 = total * texelFetch(mask3, place);
    const Offsets o = Offsets(n0.y, n1.x, n0.z, n1.y, n2.x);
    const Means m = Means(total * texelFetch(sums00, place), total * texelFetch(sums10, place),
                          total * texelFetch(sums01, place), total * texelFetch(sums20, place),
                          total * texelFetch(sums11, place), total * texelFetch(sums02, place));
    vec4 gx, gy;
    slope(m, o, gx, gy);
    const Hessian f = third_cumulants(m, o), line = offset_cumulants(n0, n1, n2, n3, o);
    const vec4 xx = (f.xx - gx * line.xx.x - gy * line.xx.y) / parameters.unit_xx;
    const vec4 xy = (f.xy - gx * line.xy.x - gy * line.xy.y) / parameters.unit_xy;
    const vec4 yy = (f.yy - gx * line.yy.x - gy * line.yy.y) / parameters.unit_xx;
    const vec4 middle = 0.5 * (xx + yy), half_difference = 0.5 * (xx - yy);
    const vec4 reach = sqrt(half_difference * half_difference + xy * xy);
    const float scale = parameters.inverse_sigma;
    return Derivatives(m.f, scale * gx, scale * gy, scale * scale * (middle + reach), scale * scale * (middle - reach));
}

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    const ImageParameters image = parameters.image;
    if (!in_image(image, at)) return;
    const uint pixel = pixel_index(image, at), pixels = pixel_count(image);
    const bool shown = in_box(image, at) && texelFetch(faces, int(pixel)).x != k_filter_no_face;
    Derivatives d = Derivatives(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    if (shown) d = derive(int(box_index(image, at)));
    const vec4 magnitude = sqrt(d.gradient_x * d.gradient_x + d.gradient_y * d.gradient_y);
    [[unroll]] for (uint i = 0; i < k_filter_images; ++i) {
        if (i >= image.images) break;
        values[i * pixels + pixel] = d.value[i];
        gradients[i * pixels + pixel] = d.gradient_x[i];
        gradients[(image.images + i) * pixels + pixel] = d.gradient_y[i];
        magnitudes[i * pixels + pixel] = magnitude[i];
        curvatures[i * pixels + pixel] = d.largest[i];
        curvatures[(image.images + i) * pixels + pixel] = d.least[i];
    }
}
