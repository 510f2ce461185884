#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/imaging/image.h"

namespace exemplar {

/// Convolution of an image of one channel with a Gaussian of standard deviation `sigma` pixels; beyond its border the
/// image goes on as its outermost pixels. A sigma of zero or less changes nothing.
FloatImage gaussian_blur(const FloatImage& image, float sigma);

/// Derivatives of an image along x and y.
struct ImageGradient {
    FloatImage x, y;
};
/// The gradient of the image as gaussian_blur blurs it, in 1 / pixels: by derivatives of the Gaussian, as differences
/// of neighboring pixels would turn the gradients of thin lines by some degrees. sigma is positive.
ImageGradient gaussian_gradient(const FloatImage& image, float sigma);

/// For each pixel of an image the index of the nearest one (Euclidean, between centers) whose `is_site` is not zero,
/// or k_no_site if there is none; of equally near ones always the same. Linear time: Meijster et al. 2000.
constexpr std::int32_t k_no_site = -1;
std::vector<std::int32_t> nearest_sites(int width, int height, std::span<const std::uint8_t> is_site);

/// Distance in pixels between the centers of two pixels given by index.
float pixel_distance(std::int32_t first, std::int32_t second, int width);

}  // namespace exemplar
