#include "host/imaging/image_derivatives.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/imaging/plane.h"
#include "host/imaging/scan_conversion.h"

namespace exemplar {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// The mask within its bounding box.
struct Mask {
    PixelBox box;
    Plane inside;  ///< 1 or 0

    bool at(std::size_t x, std::size_t y) const { return inside.row(y)[x] != 0; }
};

Mask mask_of(std::span<const std::uint32_t> face, int width, const PixelBox& box) {
    Mask mask{box, Plane(static_cast<std::size_t>(box.width), static_cast<std::size_t>(box.height))};
    for (int y = 0; y < box.height; ++y)
        for (int x = 0; x < box.width; ++x) {
            const auto pixel = static_cast<std::size_t>(box.y + y) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(box.x + x);
            mask.inside.row(static_cast<std::size_t>(y))[static_cast<std::size_t>(x)] = face[pixel] != k_no_face;
        }
    return mask;
}

/// Calls use(x, y, pixel) for the mask's pixels, in parallel, with their position in the box and their index in the
/// image.
template <typename Use>
void for_each_inside(const Mask& mask, int width, Use&& use) {
    parallel_for(mask.inside.height, [&](std::size_t y) {
        const std::size_t first = (static_cast<std::size_t>(mask.box.y) + y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(mask.box.x);
        for (std::size_t x = 0; x < mask.inside.width; ++x)
            if (mask.at(x, y)) use(x, y, first + x);
    });
}

/// Returns an image within the mask's box, zero outside of the mask.
Plane masked(const Mask& mask, const ImageStack& images, std::size_t image) {
    Plane plane(mask.inside.width, mask.inside.height);
    for_each_inside(mask, images.width, [&](std::size_t x, std::size_t y, std::size_t pixel) {
        plane.row(y)[x] = static_cast<double>(images.image(image)[pixel]);
    });
    return plane;
}

/// Returns the weights of a Gaussian times a power of the offset, in units of sigma.
std::vector<double> weights_of_order(const GaussianKernel& kernel, int order) {
    std::vector<double> weights = kernel.weights;
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] *= std::pow((static_cast<double>(i) - kernel.radius) / static_cast<double>(kernel.sigma), order);
    return weights;
}

/// Gaussian-weighted sums of a plane's pixels times x^i y^j, offsets in units of sigma, for i + j <= order.
class MomentPlanes {
  public:
    MomentPlanes(const Plane& plane, const GaussianKernel& kernel, int order) {
        for (int i = 0; i <= order; ++i) {
            const Plane along_x = weighted_sums_along_x(plane, weights_of_order(kernel, i));
            for (int j = 0; i + j <= order; ++j)
                planes_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
                    weighted_sums_along_y(along_x, weights_of_order(kernel, j));
        }
    }
    double operator()(std::size_t i, std::size_t j, std::size_t x, std::size_t y) const {
        return planes_[i][j].row(y)[x];
    }

  private:
    std::array<std::array<Plane, 4>, 4> planes_;
};

/// Weighted means around a pixel of a quantity f and its products with the offsets x and y.
struct Means {
    double f, fx, fy, fxx, fxy, fyy;
};

Means means_at(const MomentPlanes& sums, std::size_t x, std::size_t y, double total) {
    return {sums(0, 0, x, y) / total, sums(1, 0, x, y) / total, sums(0, 1, x, y) / total,
            sums(2, 0, x, y) / total, sums(1, 1, x, y) / total, sums(0, 2, x, y) / total};
}

/// Moments of the mask around one of its pixels: the means of offsets and their products, and of x and y as `Means`.
struct MaskMoments {
    double total;  ///< sum of the weights
    double x, y, xx, xy, yy;
    Means of_x, of_y;
};

MaskMoments mask_moments_at(const MomentPlanes& mask, std::size_t x, std::size_t y) {
    const double total = mask(0, 0, x, y);
    const auto mean = [&](std::size_t i, std::size_t j) { return mask(i, j, x, y) / total; };
    return {.total = total,
            .x = mean(1, 0),
            .y = mean(0, 1),
            .xx = mean(2, 0),
            .xy = mean(1, 1),
            .yy = mean(0, 2),
            .of_x = {mean(1, 0), mean(2, 0), mean(1, 1), mean(3, 0), mean(2, 1), mean(1, 2)},
            .of_y = {mean(0, 1), mean(1, 1), mean(0, 2), mean(2, 1), mean(1, 2), mean(0, 3)}};
}

/// Returns the larger and the smaller eigenvalue of a symmetric matrix.
std::array<double, 2> eigenvalues(double xx, double xy, double yy) {
    const double middle = (xx + yy) / 2, reach = std::hypot((xx - yy) / 2, xy);
    return {middle + reach, middle - reach};
}

/// Returns the inverse of an eigenvalue of the spread; fades to zero if there is too little spread for a slope.
double inverse(double spread) {
    return std::pow(spread, 3) / (std::pow(spread, 4) + std::pow(static_cast<double>(k_min_spread), 4));
}

/// Returns the slope of the least-squares line, per sigma: the inverse of the spread of offsets times their
/// covariance with f.
Vector2d slope(const Means& m, const MaskMoments& s) {
    const Vector2d covariance{m.fx - m.f * s.x, m.fy - m.f * s.y};
    const double xx = s.xx - s.x * s.x, xy = s.xy - s.x * s.y, yy = s.yy - s.y * s.y;
    const auto [largest, least] = eigenvalues(xx, xy, yy);
    const double first = inverse(largest), second = inverse(std::max(least, 0.0));
    // The eigenvectors are (cos t, sin t) and (-sin t, cos t); `turn` is the matrix of cos 2t and sin 2t.
    Matrix2d turn;
    turn << (xx - yy) / 2, xy, xy, (yy - xx) / 2;
    const double reach = (largest - least) / 2;
    if (reach > 0) turn /= reach;
    return (first + second) / 2 * covariance + (first - second) / 2 * (turn * covariance);
}

/// Returns the joint third cumulants (f, x, x), (f, x, y), (f, y, y). Under Gaussian weights they are the second
/// derivatives of the mean of f with respect to the pixel's position, times sigma^4 with offsets in pixels.
std::array<double, 3> third_cumulants(const Means& m, const MaskMoments& s) {
    return {m.fxx - 2 * m.fx * s.x - m.f * s.xx + 2 * m.f * s.x * s.x,
            m.fxy - m.fx * s.y - m.fy * s.x - m.f * s.xy + 2 * m.f * s.x * s.y,
            m.fyy - 2 * m.fy * s.y - m.f * s.yy + 2 * m.f * s.y * s.y};
}

/// Returns xx, xy and yy of the Hessian, per sigma^2.
std::array<double, 3> hessian(const Means& m, const MaskMoments& s, const Vector2d& line, const CumulantUnits& units) {
    const std::array<double, 3> of_f = third_cumulants(m, s), of_x = third_cumulants(s.of_x, s),
                                of_y = third_cumulants(s.of_y, s);
    std::array<double, 3> h;
    for (std::size_t i = 0; i < 3; ++i)
        h[i] = (of_f[i] - line.x() * of_x[i] - line.y() * of_y[i]) / (i == 1 ? units.xy : units.xx);
    return h;
}

void set(ImageStack& stack, std::size_t image, std::size_t pixel, double value) {
    stack.image(image)[pixel] = static_cast<float>(value);
}

/// Computes values, gradients and curvatures of one image; returns the planes of its gradient.
std::array<Plane, 2> derive(const ImageStack& images, std::size_t image, const Mask& mask,
                            const MomentPlanes& mask_moments, const GaussianKernel& kernel, ImageDerivatives& out) {
    const MomentPlanes moments(masked(mask, images, image), kernel, 2);
    const CumulantUnits units = cumulant_units(kernel);
    const auto sigma = static_cast<double>(kernel.sigma);
    std::array<Plane, 2> gradient{Plane(mask.inside.width, mask.inside.height),
                                  Plane(mask.inside.width, mask.inside.height)};
    for_each_inside(mask, images.width, [&](std::size_t x, std::size_t y, std::size_t pixel) {
        const MaskMoments s = mask_moments_at(mask_moments, x, y);
        const Means m = means_at(moments, x, y, s.total);
        const Vector2d line = slope(m, s);
        const auto [xx, xy, yy] = hessian(m, s, line, units);
        const auto [largest, least] = eigenvalues(xx, xy, yy);
        set(out.value, image, pixel, m.f);
        set(out.gradient_x, image, pixel, gradient[0].row(y)[x] = line.x() / sigma);
        set(out.gradient_y, image, pixel, gradient[1].row(y)[x] = line.y() / sigma);
        set(out.gradient_magnitude, image, pixel, line.norm() / sigma);
        set(out.maximum_curvature, image, pixel, largest / (sigma * sigma));
        set(out.minimum_curvature, image, pixel, least / (sigma * sigma));
    });
    return gradient;
}

/// Computes the orientation of the structure tensor. The total weight cancels, so weighted sums replace means.
void orient(const std::array<Plane, 2>& gradient, std::size_t image, const Mask& mask, const GaussianKernel& kernel,
            ImageDerivatives& out) {
    Plane trace(mask.inside.width, mask.inside.height), difference = trace, product = trace;
    for (std::size_t i = 0; i < trace.values.size(); ++i) {
        const double gx = gradient[0].values[i], gy = gradient[1].values[i];
        trace.values[i] = gx * gx + gy * gy;
        difference.values[i] = gx * gx - gy * gy;
        product.values[i] = 2 * gx * gy;
    }
    for (Plane* plane : {&trace, &difference, &product})
        *plane = weighted_sums_along_y(weighted_sums_along_x(*plane, kernel.weights), kernel.weights);
    const double noise = std::pow(static_cast<double>(k_min_gradient), 2);
    for_each_inside(mask, out.value.width, [&](std::size_t x, std::size_t y, std::size_t pixel) {
        const double scale = 1 / (trace.row(y)[x] + noise);
        set(out.orientation_cos, image, pixel, scale * difference.row(y)[x]);
        set(out.orientation_sin, image, pixel, scale * product.row(y)[x]);
    });
}

}  // namespace

CumulantUnits cumulant_units(const GaussianKernel& kernel) {
    const double second = kernel.moment(2);
    return {(kernel.moment(4) - second * second) / 2, second * second};
}

std::vector<ImageStack> CpuImageFilters::blurred(const ImageStack& images, std::span<const float> sigmas) {
    std::vector<ImageStack> result;
    result.reserve(sigmas.size());
    for (const float sigma : sigmas) result.push_back(gaussian_blur(images, sigma));
    return result;
}

void check_derivatives(const ImageStack& images, std::span<const std::uint32_t> face) {
    if (images.count < 1 || images.count > k_max_derived_images)
        throw UsageError(fmt::format("derivatives of {} images; give 1 to {}", images.count, k_max_derived_images));
    if (face.size() != images.pixels())
        throw UsageError(fmt::format("derivatives: {} faces for {} x {} pixels; give one per pixel", face.size(),
                                     images.width, images.height));
}

std::optional<PixelBox> mask_box(std::span<const std::uint32_t> face, int width) {
    int left = width, right = -1, top = -1, bottom = -1;
    const int height = width > 0 ? static_cast<int>(face.size() / static_cast<std::size_t>(width)) : 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (face[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] ==
                k_no_face)
                continue;
            left = std::min(left, x);
            right = std::max(right, x);
            if (top < 0) top = y;
            bottom = y;
        }
    if (right < 0) return std::nullopt;
    return PixelBox{left, top, right - left + 1, bottom - top + 1};
}

ImageDerivatives CpuImageFilters::derivatives(const ImageStack& images, std::span<const std::uint32_t> face,
                                              float sigma, bool with_orientations) {
    check_derivatives(images, face);
    const GaussianKernel kernel = gaussian_kernel(sigma);
    const ImageStack zeros(images.width, images.height, images.count);
    ImageDerivatives out{zeros, zeros, zeros, zeros, zeros, zeros, {}, {}};
    if (with_orientations) out.orientation_cos = out.orientation_sin = zeros;
    const std::optional<PixelBox> box = mask_box(face, images.width);
    if (!box) return out;
    const Mask mask = mask_of(face, images.width, *box);
    const MomentPlanes mask_moments(mask.inside, kernel, 3);
    for (std::size_t image = 0; image < images.count; ++image) {
        const std::array<Plane, 2> gradient = derive(images, image, mask, mask_moments, kernel, out);
        if (with_orientations) orient(gradient, image, mask, kernel, out);
    }
    return out;
}

}  // namespace exemplar
