#pragma once

#include <vector>

#include "host/imaging/image.h"

namespace exemplar {

/// A Gaussian at whole pixels, cut off at four standard deviations; its weights sum to 1.
struct GaussianKernel {
    float sigma;                  ///< pixels
    int radius;                   ///< pixels
    std::vector<double> weights;  ///< of offsets -radius to radius

    /// The mean of (offset / sigma)^power: nearly that of the Gaussian, 1 for power 2 and 3 for power 4.
    double moment(int power) const;
};

constexpr float k_least_sigma = 0.5f, k_largest_sigma = 200;

/// Throws UsageError unless sigma is between k_least_sigma and k_largest_sigma.
GaussianKernel gaussian_kernel(float sigma);

/// The images convolved with a Gaussian, as if they were zero outside. sigma as for gaussian_kernel.
ImageStack gaussian_blur(const ImageStack& images, float sigma);

}  // namespace exemplar
