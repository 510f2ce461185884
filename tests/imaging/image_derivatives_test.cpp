#include "host/imaging/image_derivatives.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/imaging/scan_conversion.h"

namespace exemplar {
namespace {

using Faces = std::vector<std::uint32_t>;
using Function = std::function<double(double x, double y)>;

const std::vector<float> k_sigmas{1, 2, 3, 5};

Faces faces_where(int width, int height, const std::function<bool(int, int)>& inside) {
    Faces faces;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) faces.push_back(inside(x, y) ? 7 : k_no_face);
    return faces;
}

/// A disk with a hole, cut by the image's left border, and a bar below it.
Faces some_shape(int width, int height) {
    return faces_where(width, height, [&](int x, int y) {
        const double from_center = std::hypot(x - 0.3 * width, y - 0.4 * height) / height;
        return (from_center < 0.35 && from_center > 0.1) || (x > 0.4 * width && y > 0.85 * height);
    });
}

ImageStack sampled(int width, int height, const Function& f) {
    ImageStack images(width, height, 1);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) images.values[images.index(x, y)] = static_cast<float>(f(x, y));
    return images;
}

ImageStack random_images(int width, int height, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    ImageStack images(width, height, count);
    for (float& value : images.values) value = static_cast<float>(random.uniform());
    return images;
}

ImageDerivatives derivatives(const ImageStack& images, const Faces& faces, float sigma) {
    return CpuImageFilters().derivatives(images, faces, sigma);
}

template <typename Use>
void for_each_inside(const ImageStack& images, const Faces& faces, Use&& use) {
    for (int y = 0; y < images.height; ++y)
        for (int x = 0; x < images.width; ++x)
            if (faces[images.index(x, y)] != k_no_face) use(x, y);
}

TEST(ImageDerivatives, LinearImagesHaveTheirSlopeUpToTheBordersOfTheMask) {
    const ImageStack image = sampled(83, 71, [](double x, double y) { return 0.3 + 0.004 * x - 0.007 * y; });
    for (const float sigma : k_sigmas) {
        const Faces faces = some_shape(image.width, image.height);
        const ImageDerivatives d = derivatives(image, faces, sigma);
        for_each_inside(image, faces, [&](int x, int y) {
            EXPECT_NEAR(d.gradient_x.at(0, x, y), 0.004, 4e-7);
            EXPECT_NEAR(d.gradient_y.at(0, x, y), -0.007, 7e-7);
            EXPECT_NEAR(d.gradient_magnitude.at(0, x, y), std::hypot(0.004, 0.007), 1e-6);
            EXPECT_NEAR(d.maximum_curvature.at(0, x, y), 0, 1e-6);
            EXPECT_NEAR(d.minimum_curvature.at(0, x, y), 0, 1e-6);
            const double doubled = 2 * std::atan2(-0.007, 0.004);
            EXPECT_NEAR(d.orientation_cos.at(0, x, y), std::cos(doubled), 1e-3);
            EXPECT_NEAR(d.orientation_sin.at(0, x, y), std::sin(doubled), 1e-3);
        });
    }
}

TEST(ImageDerivatives, QuadraticImagesHaveTheirHessianInside) {
    constexpr double k_xx = 2e-4, k_xy = -1.5e-4, k_yy = -5e-5;
    const ImageStack image = sampled(101, 97, [](double x, double y) {
        return 0.2 + 1e-3 * x + 0.5 * k_xx * x * x + k_xy * x * y + 0.5 * k_yy * y * y;
    });
    const double middle = (k_xx + k_yy) / 2, reach = std::hypot((k_xx - k_yy) / 2, k_xy);
    const Faces all(image.pixels(), 0);
    for (const float sigma : k_sigmas) {
        const ImageDerivatives d = derivatives(image, all, sigma);
        const int margin = static_cast<int>(4 * sigma);
        for (int y = margin; y < image.height - margin; ++y)
            for (int x = margin; x < image.width - margin; ++x) {
                ASSERT_NEAR(d.gradient_x.at(0, x, y), 1e-3 + k_xx * x + k_xy * y, 1e-6);
                ASSERT_NEAR(d.gradient_y.at(0, x, y), k_xy * x + k_yy * y, 1e-6);
                ASSERT_NEAR(d.maximum_curvature.at(0, x, y), middle + reach, 1e-6);
                ASSERT_NEAR(d.minimum_curvature.at(0, x, y), middle - reach, 1e-6);
            }
    }
}

/// The value and the slope of the weighted least-squares line, from their definition.
Eigen::Vector3d fitted_line(const ImageStack& image, const Faces& faces, int x, int y, float sigma) {
    const int radius = gaussian_kernel(sigma).radius;
    std::vector<Eigen::Vector4d> rows;
    double mean = 0, total = 0;
    for (int v = std::max(0, y - radius); v <= std::min(image.height - 1, y + radius); ++v)
        for (int u = std::max(0, x - radius); u <= std::min(image.width - 1, x + radius); ++u) {
            if (faces[image.index(u, v)] == k_no_face) continue;
            const double weight = std::exp(-0.5 * ((u - x) * (u - x) + (v - y) * (v - y)) / (sigma * sigma));
            const double value = image.at(0, u, v);
            rows.push_back(std::sqrt(weight) * Eigen::Vector4d(1, u - x, v - y, value));
            mean += weight * value;
            total += weight;
        }
    Eigen::MatrixXd system(rows.size(), 4);
    for (std::size_t i = 0; i < rows.size(); ++i) system.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
    const Eigen::Vector3d line = system.leftCols<3>().colPivHouseholderQr().solve(system.col(3));
    return {mean / total, line.y(), line.z()};
}

TEST(ImageDerivatives, ValuesAndSlopesAreThoseOfTheirDefinition) {
    const ImageStack image = random_images(41, 37, 1, 3);
    const Faces faces = some_shape(image.width, image.height);
    for (const float sigma : k_sigmas) {
        const ImageDerivatives d = derivatives(image, faces, sigma);
        for_each_inside(image, faces, [&](int x, int y) {
            if ((x + 3 * y) % 7 != 0) return;
            const Eigen::Vector3d line = fitted_line(image, faces, x, y, sigma);
            EXPECT_NEAR(d.value.at(0, x, y), line[0], 1e-6);
            EXPECT_NEAR(d.gradient_x.at(0, x, y), line[1], 1e-5);
            EXPECT_NEAR(d.gradient_y.at(0, x, y), line[2], 1e-5);
        });
    }
}

// Inside, all is what convolution with derivatives of the Gaussian gives of a wave: it is damped by exp(-w^2 s^2 / 2).
TEST(ImageDerivatives, WavesAreDampedAndTurnedAsByConvolution) {
    constexpr double k_angle = 0.6, k_frequency = 0.25, k_height = 0.4;
    const double wx = k_frequency * std::cos(k_angle), wy = k_frequency * std::sin(k_angle);
    const ImageStack image =
        sampled(121, 111, [&](double x, double y) { return k_height * std::sin(wx * x + wy * y); });
    for (const float sigma : k_sigmas) {
        const ImageDerivatives d = derivatives(image, Faces(image.pixels(), 0), sigma);
        const double damped = k_height * std::exp(-0.5 * std::pow(k_frequency * sigma, 2));
        const int margin = static_cast<int>(8 * sigma);
        // What is cut off of the Gaussian, and of its products with x^2, is below 1/1000 and 1/100.
        for (int y = margin; y < image.height - margin; ++y)
            for (int x = margin; x < image.width - margin; ++x) {
                const double phase = wx * x + wy * y;
                ASSERT_NEAR(d.value.at(0, x, y), damped * std::sin(phase), 1e-3 * k_height);
                ASSERT_NEAR(d.gradient_x.at(0, x, y), damped * wx * std::cos(phase), 3e-3 * k_height * k_frequency);
                const double curvature = -damped * k_frequency * k_frequency * std::sin(phase);
                const double error = 2e-2 * k_height * k_frequency * k_frequency;
                ASSERT_NEAR(d.maximum_curvature.at(0, x, y), std::max(curvature, 0.0), error);
                ASSERT_NEAR(d.minimum_curvature.at(0, x, y), std::min(curvature, 0.0), error);
                ASSERT_NEAR(d.orientation_cos.at(0, x, y), std::cos(2 * k_angle), 2e-2);
                ASSERT_NEAR(d.orientation_sin.at(0, x, y), std::sin(2 * k_angle), 2e-2);
            }
    }
}

TEST(ImageDerivatives, ABumpHasNoOrientationAtItsTop) {
    const ImageStack image = sampled(
        61, 61, [](double x, double y) { return std::exp(-0.5 * (std::pow(x - 30, 2) + std::pow(y - 30, 2)) / 36); });
    const ImageDerivatives d = derivatives(image, Faces(image.pixels(), 0), 3);
    EXPECT_NEAR(d.orientation_cos.at(0, 30, 30), 0, 1e-5);
    EXPECT_NEAR(d.orientation_sin.at(0, 30, 30), 0, 1e-5);
    EXPECT_GT(d.orientation_cos.at(0, 40, 30), 0.5);
    EXPECT_LT(d.orientation_cos.at(0, 30, 40), -0.5);
    EXPECT_GT(d.orientation_sin.at(0, 38, 38), 0.5);
    EXPECT_LT(d.orientation_sin.at(0, 38, 22), -0.5);
    EXPECT_LT(d.maximum_curvature.at(0, 30, 30), -0.01);
}

TEST(ImageDerivatives, ConstantImagesHaveNone) {
    const ImageStack image(50, 40, 2, 0.7f);
    const Faces faces = some_shape(50, 40);
    for (const float sigma : k_sigmas) {
        const ImageDerivatives d = derivatives(image, faces, sigma);
        for (std::size_t i = 0; i < 2; ++i)
            for_each_inside(image, faces, [&](int x, int y) {
                EXPECT_NEAR(d.value.at(i, x, y), 0.7f, 1e-6);
                for (const ImageStack* stack : {&d.gradient_x, &d.gradient_y, &d.gradient_magnitude,
                                                &d.maximum_curvature, &d.minimum_curvature, &d.orientation_cos})
                    EXPECT_NEAR(stack->at(i, x, y), 0, 1e-7);
            });
    }
}

TEST(ImageDerivatives, WhatIsOutsideOfTheMaskIsNeverSeen) {
    const ImageStack image = random_images(45, 33, 3, 8);
    const Faces faces = some_shape(45, 33);
    ImageStack changed = image;
    for (std::size_t i = 0; i < changed.count; ++i)
        for (std::size_t p = 0; p < changed.pixels(); ++p)
            if (faces[p] == k_no_face) changed.image(i)[p] = std::numeric_limits<float>::quiet_NaN();
    const ImageDerivatives a = derivatives(image, faces, 2), b = derivatives(changed, faces, 2);
    EXPECT_EQ(a.value, b.value);
    EXPECT_EQ(a.minimum_curvature, b.minimum_curvature);
    EXPECT_EQ(a.orientation_sin, b.orientation_sin);
    for (std::size_t p = 0; p < image.pixels(); ++p)
        if (faces[p] == k_no_face) {
            EXPECT_EQ(a.value.image(2)[p], 0);
            EXPECT_EQ(a.orientation_cos.image(1)[p], 0);
        }
}

// (x, y) goes to (height - 1 - y, x): a turn from the x axis to the y axis.
TEST(ImageDerivatives, TurnWithTheImage) {
    const ImageStack image = random_images(40, 29, 1, 5);
    const Faces faces = some_shape(40, 29);
    ImageStack turned(29, 40, 1);
    Faces turned_faces(turned.pixels());
    const auto turn = [&](auto&& use) {
        for (int y = 0; y < 29; ++y)
            for (int x = 0; x < 40; ++x) use(x, y, 28 - y, x);
    };
    turn([&](int x, int y, int u, int v) {
        turned.values[turned.index(u, v)] = image.at(0, x, y);
        turned_faces[turned.index(u, v)] = faces[image.index(x, y)];
    });
    for (const float sigma : k_sigmas) {
        const ImageDerivatives a = derivatives(image, faces, sigma), b = derivatives(turned, turned_faces, sigma);
        turn([&](int x, int y, int u, int v) {
            EXPECT_NEAR(b.value.at(0, u, v), a.value.at(0, x, y), 1e-6);
            EXPECT_NEAR(b.gradient_x.at(0, u, v), -a.gradient_y.at(0, x, y), 1e-6);
            EXPECT_NEAR(b.gradient_y.at(0, u, v), a.gradient_x.at(0, x, y), 1e-6);
            EXPECT_NEAR(b.gradient_magnitude.at(0, u, v), a.gradient_magnitude.at(0, x, y), 1e-6);
            EXPECT_NEAR(b.maximum_curvature.at(0, u, v), a.maximum_curvature.at(0, x, y), 1e-6);
            EXPECT_NEAR(b.minimum_curvature.at(0, u, v), a.minimum_curvature.at(0, x, y), 1e-6);
            EXPECT_NEAR(b.orientation_cos.at(0, u, v), -a.orientation_cos.at(0, x, y), 1e-5);
            EXPECT_NEAR(b.orientation_sin.at(0, u, v), -a.orientation_sin.at(0, x, y), 1e-5);
        });
    }
}

TEST(ImageDerivatives, AreOfEachImageByItself) {
    const ImageStack images = random_images(23, 19, 4, 6);
    const Faces faces = some_shape(23, 19);
    const ImageDerivatives together = derivatives(images, faces, 2);
    for (std::size_t i = 0; i < 4; ++i) {
        ImageStack one(23, 19, 1);
        std::ranges::copy(images.image(i), one.values.begin());
        const ImageDerivatives alone = derivatives(one, faces, 2);
        EXPECT_TRUE(std::ranges::equal(together.maximum_curvature.image(i), alone.maximum_curvature.values));
        EXPECT_TRUE(std::ranges::equal(together.orientation_cos.image(i), alone.orientation_cos.values));
    }
}

TEST(ImageDerivatives, TinyMasksHaveWhatTheyCanTell) {
    const ImageStack image = sampled(30, 20, [](double x, double y) { return 0.02 * x + 0.01 * y; });
    for (const float sigma : k_sigmas) {
        const ImageDerivatives none = derivatives(image, Faces(600, k_no_face), sigma);
        EXPECT_EQ(none.value, ImageStack(30, 20, 1));
        EXPECT_EQ(none.orientation_sin, ImageStack(30, 20, 1));

        const auto pixel = faces_where(30, 20, [](int x, int y) { return x == 29 && y == 19; });
        const ImageDerivatives one = derivatives(image, pixel, sigma);
        EXPECT_NEAR(one.value.at(0, 29, 19), 0.77, 1e-6);
        EXPECT_EQ(one.gradient_magnitude, ImageStack(30, 20, 1));
        EXPECT_EQ(one.maximum_curvature, ImageStack(30, 20, 1));

        // A line of pixels tells the slope along it only.
        const auto line = faces_where(30, 20, [](int, int y) { return y == 7; });
        const ImageDerivatives along = derivatives(image, line, sigma);
        for (int x = 0; x < 30; ++x) {
            EXPECT_NEAR(along.gradient_x.at(0, x, 7), 0.02, 1e-5);
            EXPECT_NEAR(along.gradient_y.at(0, x, 7), 0, 1e-9);
        }
    }
}

TEST(ImageDerivatives, OrientationsCanBeLeftOut) {
    const ImageStack images = random_images(31, 29, 3, 7);
    const Faces faces = some_shape(31, 29);
    const ImageDerivatives all = derivatives(images, faces, 2);
    const ImageDerivatives some = CpuImageFilters().derivatives(images, faces, 2, false);
    EXPECT_EQ(some.value, all.value);
    EXPECT_EQ(some.gradient_y, all.gradient_y);
    EXPECT_EQ(some.minimum_curvature, all.minimum_curvature);
    EXPECT_EQ(some.orientation_cos, ImageStack());
    EXPECT_EQ(some.orientation_sin, ImageStack());
}

TEST(ImageDerivatives, DoNotDependOnTheNumberOfThreads) {
    const ImageStack images = random_images(60, 50, 2, 9);
    const Faces faces = some_shape(60, 50);
    const ImageDerivatives many = derivatives(images, faces, 3);
    const ThreadLimit one(1);
    const ImageDerivatives single = derivatives(images, faces, 3);
    EXPECT_EQ(single.gradient_x, many.gradient_x);
    EXPECT_EQ(single.minimum_curvature, many.minimum_curvature);
    EXPECT_EQ(single.orientation_cos, many.orientation_cos);
}

TEST(ImageDerivatives, RefuseWhatDoesNotFit) {
    const Faces faces(12, 0);
    EXPECT_THROW(derivatives(ImageStack(4, 3, 0), faces, 1), UsageError);
    EXPECT_THROW(derivatives(ImageStack(4, 3, 5), faces, 1), UsageError);
    EXPECT_THROW(derivatives(ImageStack(4, 4, 1), faces, 1), UsageError);
    for (const float sigma : {0.0f, -1.0f, 0.4f, 1000.0f, std::numeric_limits<float>::quiet_NaN()})
        EXPECT_THROW(derivatives(ImageStack(4, 3, 1), faces, sigma), UsageError);
    EXPECT_EQ(derivatives(ImageStack(0, 0, 1), {}, 1).value, ImageStack(0, 0, 1));
}

TEST(MaskBox, IsTheSmallestAroundAllPixels) {
    const auto faces = faces_where(9, 6, [](int x, int y) { return (x == 2 && y == 4) || (x == 8 && y == 1); });
    EXPECT_EQ(mask_box(faces, 9), (PixelBox{2, 1, 7, 4}));
    EXPECT_EQ(mask_box(Faces(54, 0), 9), (PixelBox{0, 0, 9, 6}));
    EXPECT_EQ(mask_box(Faces(54, k_no_face), 9), std::nullopt);
    EXPECT_EQ(mask_box({}, 0), std::nullopt);
}

TEST(GaussianBlur, IsTheConvolutionOfItsDefinition) {
    const ImageStack image = random_images(37, 26, 2, 4);
    for (const float sigma : {1.0f, 5.0f, 20.0f}) {
        const ImageStack blurred = CpuImageFilters().blurred(image, sigma);
        const GaussianKernel kernel = gaussian_kernel(sigma);
        const auto weight = [&](int k) {
            const std::ptrdiff_t offset = std::ptrdiff_t{kernel.radius} + k;
            return std::abs(k) > kernel.radius ? 0 : kernel.weights[static_cast<std::size_t>(offset)];
        };
        for (int y = 0; y < image.height; y += 5)
            for (int x = 0; x < image.width; x += 4) {
                double sum = 0;
                for (int v = 0; v < image.height; ++v)
                    for (int u = 0; u < image.width; ++u) sum += weight(u - x) * weight(v - y) * image.at(1, u, v);
                EXPECT_NEAR(blurred.at(1, x, y), sum, 1e-6);
            }
    }
}

TEST(GaussianBlur, SpreadsAPointAsTheGaussian) {
    ImageStack point(81, 81, 1);
    point.values[point.index(40, 40)] = 1;
    const ImageStack blurred = gaussian_blur(point, 5);
    double sum = 0;
    for (const float value : blurred.values) sum += value;
    EXPECT_NEAR(sum, 1, 1e-5);
    const double top = 1 / (2 * std::numbers::pi * 25);
    EXPECT_NEAR(blurred.at(0, 40, 40), top, 1e-3 * top);
    EXPECT_NEAR(blurred.at(0, 43, 36), top * std::exp(-0.5), 1e-3 * top);
}

TEST(GaussianKernel, IsSymmetricAndHasTheMomentsOfTheGaussian) {
    for (const float sigma : {1.0f, 2.7f, 20.0f}) {
        const GaussianKernel kernel = gaussian_kernel(sigma);
        EXPECT_EQ(kernel.weights.size(), 2 * static_cast<std::size_t>(kernel.radius) + 1);
        EXPECT_NEAR(kernel.moment(0), 1, 1e-12);
        EXPECT_NEAR(kernel.moment(1), 0, 1e-12);
        EXPECT_NEAR(kernel.moment(2), 1, 0.01);
        EXPECT_NEAR(kernel.moment(4), 3, 0.05);
    }
}

}  // namespace
}  // namespace exemplar
