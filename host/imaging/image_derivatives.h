#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "host/imaging/gaussian.h"
#include "host/imaging/image.h"

namespace exemplar {

/// The maximum number of images that are differentiated at once.
constexpr std::size_t k_max_derived_images = 4;

/// A rectangle of pixels.
struct PixelBox {
    int x = 0, y = 0;  ///< of its upper left pixel
    int width = 0, height = 0;
    bool operator==(const PixelBox&) const = default;
};

/// Smoothed values and derivatives of images inside a mask, all at one scale sigma (thesis App. B.2 and B.3). Each
/// stack has as many images as there were, zero outside of the mask. x is to the right, y down, and lengths are
/// pixels. Pixels outside of the mask have no influence: all results are functions of Gaussian-weighted means over
/// the pixels inside.
struct ImageDerivatives {
    /// The weighted mean (normalized convolution).
    ImageStack value;
    /// The slope of the weighted least-squares line (Knutsson and Westin 1993, "Normalized and differential
    /// convolution"). Away from the mask's border it is the convolution with a Gaussian's derivative; near the
    /// border it stays exact for linear images. Slopes fade to zero across parts of the mask that are too narrow:
    /// one pixel, or two for sigma 5 and more.
    ImageStack gradient_x, gradient_y, gradient_magnitude;
    /// The eigenvalues of the Hessian in 1 / pixel^2: the principal curvatures of the height field z = value(x, y),
    /// up to terms of the squared gradient. The Hessian is that of the weighted mean, less what the slope alone
    /// contributes near the mask's border, so it is zero for linear images. Away from the border it is the
    /// convolution with a Gaussian's second derivatives, exact for quadratic images; near it, smaller.
    ImageStack maximum_curvature, minimum_curvature;  ///< by sign
    /// Coherence times (cos 2a, sin 2a); no images if left out. a is the direction of largest change: the first
    /// eigenvector of the structure tensor, the weighted mean of gradient gradient^T. The coherence is the
    /// difference of the tensor's eigenvalues over their sum: 1 if all gradients are parallel, 0 if no direction is
    /// preferred. It vanishes, for values from 0 to 1, where gradients are far below k_min_gradient.
    ImageStack orientation_cos, orientation_sin;
};

/// Gradients below this, per pixel, count as noise in the coherence of orientations.
constexpr float k_min_gradient = 1e-4f;
/// The spread is the weighted covariance of the offsets of the mask's pixels, over sigma^2; its inverse gives the
/// slope. Where it is below this value slopes fade: an eigenvalue l counts as l + k_min_spread^4 / l^3.
constexpr float k_min_spread = 1e-2f;

/// The third cumulants (f, x, x) of f = x^2 / 2 and (f, x, y) of f = x y under a Gaussian, offsets per sigma.
/// Dividing by them turns cumulants into second derivatives. Both would be 1 if the Gaussian were not sampled and
/// cut off.
struct CumulantUnits {
    double xx, xy;
};
CumulantUnits cumulant_units(const GaussianKernel& kernel);

/// Filters of images. The CPU implementation is the reference; gpu/imaging implements it in shaders.
class ImageFilters {
  public:
    virtual ~ImageFilters() = default;
    /// Computes the derivatives. `face` has a number per pixel, k_no_face outside of the mask, as in G-buffers.
    /// Images must be finite inside the mask; their values outside do not matter. Rounding errors are those of
    /// values up to about 1. Orientations, a third of the work, may be left out. Throws UsageError unless there are
    /// 1 to k_max_derived_images images, with a face for each pixel, and gaussian_kernel accepts sigma.
    virtual ImageDerivatives derivatives(const ImageStack& images, std::span<const std::uint32_t> face, float sigma,
                                         bool with_orientations = true) = 0;
    /// Convolves any number of images with Gaussians, as if they were zero outside; returns the images for each sigma.
    /// Throws UsageError as gaussian_kernel.
    virtual std::vector<ImageStack> blurred(const ImageStack& images, std::span<const float> sigmas) = 0;
    ImageStack blurred(const ImageStack& images, float sigma) {
        return std::move(blurred(images, std::span(&sigma, 1)).front());
    }
};

class CpuImageFilters final : public ImageFilters {
  public:
    ImageDerivatives derivatives(const ImageStack& images, std::span<const std::uint32_t> face, float sigma,
                                 bool with_orientations = true) override;
    std::vector<ImageStack> blurred(const ImageStack& images, std::span<const float> sigmas) override;
    using ImageFilters::blurred;
};

/// Throws UsageError, as ImageFilters::derivatives documents, if images and faces do not fit together.
void check_derivatives(const ImageStack& images, std::span<const std::uint32_t> face);

/// Returns the smallest rectangle around all pixels of the mask; nothing if there are none.
std::optional<PixelBox> mask_box(std::span<const std::uint32_t> face, int width);

}  // namespace exemplar
