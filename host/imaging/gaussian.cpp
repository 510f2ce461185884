#include "host/imaging/gaussian.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/core/errors.h"
#include "host/imaging/plane.h"

namespace exemplar {

double GaussianKernel::moment(int power) const {
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i)
        sum += weights[i] * std::pow((static_cast<double>(i) - radius) / static_cast<double>(sigma), power);
    return sum;
}

GaussianKernel gaussian_kernel(float sigma) {
    if (!(sigma >= k_min_sigma && sigma <= k_max_sigma))
        throw UsageError(fmt::format("a Gaussian of {} pixels; give {} to {}", sigma, k_min_sigma, k_max_sigma));
    GaussianKernel kernel{.sigma = sigma, .radius = static_cast<int>(std::ceil(4 * sigma)), .weights = {}};
    for (int k = -kernel.radius; k <= kernel.radius; ++k)
        kernel.weights.push_back(std::exp(-0.5 * std::pow(k / static_cast<double>(sigma), 2)));
    const double sum = std::accumulate(kernel.weights.begin(), kernel.weights.end(), 0.0);
    for (double& weight : kernel.weights) weight /= sum;
    return kernel;
}

ImageStack gaussian_blur(const ImageStack& images, float sigma) {
    const GaussianKernel kernel = gaussian_kernel(sigma);
    ImageStack out(images.width, images.height, images.count);
    for (std::size_t i = 0; i < images.count; ++i) {
        Plane plane(static_cast<std::size_t>(images.width), static_cast<std::size_t>(images.height));
        std::ranges::copy(images.image(i), plane.values.begin());
        plane = weighted_sums_along_y(weighted_sums_along_x(plane, kernel.weights), kernel.weights);
        std::ranges::transform(plane.values, out.image(i).begin(), [](double v) { return static_cast<float>(v); });
    }
    return out;
}

}  // namespace exemplar
