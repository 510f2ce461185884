#pragma once

#include <vector>

#include "host/imaging/image.h"

namespace exemplar {

/// A Gaussian sampled at whole pixels and cut off at four standard deviations; its weights sum to 1.
struct GaussianKernel {
    float sigma;                  ///< pixels
    int radius;                   ///< pixels
    std::vector<double> weights;  ///< of offsets -radius to radius

    /// Returns the mean of (offset / sigma)^power: nearly that of the Gaussian, 1 for power 2 and 3 for power 4.
    double moment(int power) const;
};

constexpr float k_min_sigma = 0.5f, k_max_sigma = 200;

/// Returns the kernel of this width. Throws UsageError unless sigma is between k_min_sigma and k_max_sigma.
GaussianKernel gaussian_kernel(float sigma);

/// Convolves the images with a Gaussian, as if they were zero outside. sigma as for gaussian_kernel.
ImageStack gaussian_blur(const ImageStack& images, float sigma);

}  // namespace exemplar
