#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "host/imaging/gaussian.h"
#include "host/imaging/image.h"

namespace exemplar {

/// How many images are differentiated at once.
constexpr std::size_t k_most_derived_images = 4;

/// A rectangle of pixels.
struct PixelBox {
    int x = 0, y = 0;  ///< of its upper left pixel
    int width = 0, height = 0;
    bool operator==(const PixelBox&) const = default;
};

/// Smoothed values and derivatives of images inside a mask, all at one scale sigma (thesis App. B.2 and B.3): stacks of
/// as many images as there were, zero outside of the mask. x is to the right, y down, and lengths are pixels.
///
/// What is outside of the mask is never seen: all are functions of Gaussian-weighted means over the pixels inside.
/// - The value is the weighted mean (normalized convolution).
/// - The gradient is the slope of the weighted least-squares line (Knutsson and Westin 1993, "Normalized and
///   differential convolution"). Away from the mask's border that is the convolution with a Gaussian's derivative; next
///   to it the slopes of linear images stay exact. Across parts of the mask that are too narrow to tell, of one
///   pixel, or two for sigma 5 and more, slopes fade to zero.
/// - The curvatures are the eigenvalues of the Hessian, in units of 1 / pixel^2: of the height field z = value(x, y)
///   they are the principal curvatures, up to terms of the squared gradient. The Hessian is that of the weighted mean,
///   less what the slope alone would contribute next to the mask's border: it is zero for linear images. Away from the
///   border it is the convolution with a Gaussian's second derivatives, exact for quadratic images; next to it,
///   smaller.
/// - The orientation is of the structure tensor, the weighted mean of gradient gradient^T: the direction a along which
///   values change most, as coherence (cos 2a, sin 2a). The coherence is the difference of the tensor's eigenvalues
///   over their sum: 1 where all gradients are along one line, 0 where no direction is different from others, and, for
///   images of values from 0 to 1, where gradients are far below k_least_gradient.
struct ImageDerivatives {
    ImageStack value;
    ImageStack gradient_x, gradient_y, gradient_magnitude;
    ImageStack maximum_curvature, minimum_curvature;  ///< by sign
    /// Of the doubled angle, times the coherence; of no images where they are left out.
    ImageStack orientation_cos, orientation_sin;
};

/// Gradients below this, per pixel, are taken for noise by the coherence of orientations.
constexpr float k_least_gradient = 1e-4f;
/// The weighted variance of the mask's pixels around a pixel, over sigma^2, below which slopes fade: an eigenvalue l of
/// the covariance of offsets, whose inverse gives the slope, counts as l + k_least_spread^4 / l^3.
constexpr float k_least_spread = 1e-2f;

/// The third cumulants (f, x, x) of f = x^2 / 2 and (f, x, y) of f = x y under a Gaussian, offsets per sigma: what
/// turns cumulants into second derivatives. Both would be 1, were it not sampled and cut off.
struct CumulantUnits {
    double xx, xy;
};
CumulantUnits cumulant_units(const GaussianKernel& kernel);

/// Filters of images. The CPU implementation is the reference; gpu/imaging implements it in shaders.
class ImageFilters {
  public:
    virtual ~ImageFilters() = default;
    /// `face` has a number per pixel, k_no_face outside of the mask, as in G-buffers. What images hold there does not
    /// matter; inside they must be finite. Results round as if values were about 1 at most. Throws UsageError unless
    /// there are 1 to k_most_derived_images images, with a face for each pixel, and sigma is one of gaussian_kernel's.
    /// Orientations, a third of the work, may be left out.
    virtual ImageDerivatives derivatives(const ImageStack& images, std::span<const std::uint32_t> face, float sigma,
                                         bool with_orientations = true) = 0;
    /// Any number of images convolved with a Gaussian, as if they were zero outside. Throws UsageError as
    /// gaussian_kernel.
    virtual ImageStack blurred(const ImageStack& images, float sigma) = 0;
};

class CpuImageFilters final : public ImageFilters {
  public:
    ImageDerivatives derivatives(const ImageStack& images, std::span<const std::uint32_t> face, float sigma,
                                 bool with_orientations = true) override;
    ImageStack blurred(const ImageStack& images, float sigma) override { return gaussian_blur(images, sigma); }
};

/// Throws what ImageFilters::derivatives says of images and faces that do not fit together.
void check_derivatives(const ImageStack& images, std::span<const std::uint32_t> face);

/// The smallest rectangle around all pixels of the mask; none if there are none.
std::optional<PixelBox> mask_box(std::span<const std::uint32_t> face, int width);

}  // namespace exemplar
