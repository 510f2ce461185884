#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/imaging/image.h"

namespace exemplar {

/// Convolves an image of one channel with a Gaussian of standard deviation `sigma` pixels. Beyond the border the
/// image is continued by its outermost pixels. Returns the image as it is if sigma is zero or less.
FloatImage gaussian_blur(const FloatImage& image, float sigma);

/// Derivatives of an image along x and y.
struct ImageGradient {
    FloatImage x, y;
};
/// Returns the gradient of gaussian_blur(image, sigma), in 1 / pixels, sigma positive. Uses derivatives of the
/// Gaussian: differences of neighboring pixels would rotate the gradients of thin lines by some degrees.
ImageGradient gaussian_gradient(const FloatImage& image, float sigma);

/// The result of nearest_sites() if there are no sites.
constexpr std::int32_t k_no_site = -1;
/// Returns, for each pixel of an image, the index of the nearest one (Euclidean, between centers) whose `is_site` is
/// not zero, or k_no_site if there is none. Ties are always broken alike. Linear time: Meijster et al. 2000.
std::vector<std::int32_t> nearest_sites(int width, int height, std::span<const std::uint8_t> is_site);

/// Returns the distance in pixels between the centers of two pixels given by index.
float pixel_distance(std::int32_t first, std::int32_t second, int width);

}  // namespace exemplar
