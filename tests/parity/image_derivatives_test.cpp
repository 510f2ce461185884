#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "gpu/imaging/image_derivatives.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/random.h"
#include "host/imaging/image_derivatives.h"
#include "host/imaging/scan_conversion.h"
#include "tests/gpu/support/environment.h"

// The device adds in floats: with values below 1, weighted means are known to about 1e-6. Slopes divide differences of
// means by the spread of the mask's pixels, in the worst case by 2 k_min_spread, and by sigma; curvatures are
// differences of means, with errors of slopes times the third cumulants of offsets, over sigma^2. Orientations divide
// by the squared gradient.
namespace exemplar {
namespace {

using test_support::shared_device;
using Faces = std::vector<std::uint32_t>;

constexpr float k_value_tolerance = 1e-5f;
constexpr float k_derivatives_tolerance = 1e-4f;  // of derivatives per sigma
constexpr float k_orientation_tolerance = 1e-3f;
constexpr float k_steep = 0.01f;  // gradients that are steep enough for that

Faces faces_where(int width, int height, const std::function<bool(int, int)>& inside) {
    Faces faces;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) faces.push_back(inside(x, y) ? static_cast<std::uint32_t>(y) : k_no_face);
    return faces;
}

ImageStack random_images(int width, int height, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    ImageStack images(width, height, count);
    for (float& value : images.values) value = static_cast<float>(random.uniform());
    return images;
}

void expect_near_images(const ImageStack& expected, const ImageStack& actual, float tolerance, const char* what) {
    ASSERT_EQ(actual.width, expected.width);
    ASSERT_EQ(actual.height, expected.height);
    ASSERT_EQ(actual.count, expected.count);
    for (std::size_t i = 0; i < expected.values.size(); ++i)
        ASSERT_NEAR(actual.values[i], expected.values[i], tolerance) << what << ' ' << i;
}

void expect_near_where_steep(const ImageStack& expected, const ImageStack& actual, const ImageStack& magnitude) {
    ASSERT_EQ(actual.values.size(), expected.values.size());
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
        ASSERT_LE(std::abs(actual.values[i]), 1.00001f);
        if (magnitude.values[i] > k_steep || expected.values[i] == 0) {
            ASSERT_NEAR(actual.values[i], expected.values[i], k_orientation_tolerance) << i;
        }
    }
}

void expect_derivatives_parity(ImageFilters& device, const ImageStack& images, const Faces& faces, float sigma) {
    SCOPED_TRACE(::testing::Message() << "sigma " << sigma);
    const ImageDerivatives expected = CpuImageFilters().derivatives(images, faces, sigma);
    const ImageDerivatives actual = device.derivatives(images, faces, sigma);
    const float first = k_derivatives_tolerance / sigma, second = k_derivatives_tolerance / (sigma * sigma);
    expect_near_images(expected.value, actual.value, k_value_tolerance, "value");
    expect_near_images(expected.gradient_x, actual.gradient_x, first, "x");
    expect_near_images(expected.gradient_y, actual.gradient_y, first, "y");
    expect_near_images(expected.gradient_magnitude, actual.gradient_magnitude, first, "magnitude");
    expect_near_images(expected.maximum_curvature, actual.maximum_curvature, second, "largest");
    expect_near_images(expected.minimum_curvature, actual.minimum_curvature, second, "least");
    expect_near_where_steep(expected.orientation_cos, actual.orientation_cos, expected.gradient_magnitude);
    expect_near_where_steep(expected.orientation_sin, actual.orientation_sin, expected.gradient_magnitude);
}

TEST(ImageDerivativesParity, OddSizesAllMasks) {
    GpuImageFilters filters(shared_device());
    std::uint64_t seed = 1;
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(65, 63), std::pair(130, 5), std::pair(3, 129)}) {
        SCOPED_TRACE(::testing::Message() << width << " x " << height);
        Random random(seed++);
        const int w = width, h = height;
        const std::vector<Faces> masks{
            Faces(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0),
            faces_where(w, h, [](int, int) { return false; }),
            faces_where(w, h, [&](int x, int y) { return x == w / 2 && y == h - 1; }),
            faces_where(w, h,
                        [&](int x, int y) { return std::hypot(x - 0.4 * w, y - 0.5 * h) < 0.4 * std::min(w, h); }),
            faces_where(w, h, [&](int x, int y) { return x > 0.7 * w || (y < 0.2 * h && x < 0.1 * w); }),
            faces_where(w, h, [&](int, int) { return random.uniform() < 0.5; }),
            faces_where(w, h, [&](int, int) { return random.uniform() < 0.03; }),
        };
        const ImageStack images = random_images(w, h, 4, seed++);
        for (std::size_t m = 0; m < masks.size(); ++m) {
            SCOPED_TRACE(::testing::Message() << "mask " << m);
            for (const float sigma : {1.0f, 2.0f, 3.0f, 5.0f})
                expect_derivatives_parity(filters, images, masks[m], sigma);
        }
    }
}

TEST(ImageDerivativesParity, AnyNumberOfImagesAndAnySigma) {
    GpuImageFilters filters(shared_device());
    const Faces faces = faces_where(70, 41, [](int x, int y) { return std::hypot(x - 30, y - 20) < 18; });
    for (std::size_t count = 1; count <= 4; ++count)
        for (const float sigma : {0.5f, 1.3f, 9.7f})
            expect_derivatives_parity(filters, random_images(70, 41, count, count), faces, sigma);
}

TEST(ImageDerivativesParity, SmoothImagesHaveOrientations) {
    GpuImageFilters filters(shared_device());
    ImageStack images(90, 77, 3);
    for (int y = 0; y < images.height; ++y)
        for (int x = 0; x < images.width; ++x) {
            const auto u = static_cast<float>(x), v = static_cast<float>(y);
            images.image(0)[images.index(x, y)] = 0.5f + 0.5f * std::sin(0.2f * u + 0.1f * v);
            images.image(1)[images.index(x, y)] = 0.01f * u;
            images.image(2)[images.index(x, y)] = std::exp(-0.002f * ((u - 40) * (u - 40) + (v - 40) * (v - 40)));
        }
    const Faces faces = faces_where(90, 77, [](int x, int y) { return std::hypot(x - 40, y - 40) < 35; });
    for (const float sigma : {1.0f, 2.0f, 3.0f, 5.0f}) expect_derivatives_parity(filters, images, faces, sigma);
}

TEST(ImageDerivativesParity, WhatIsOutsideOfTheMaskIsNeverSeen) {
    GpuImageFilters filters(shared_device());
    ImageStack images = random_images(67, 35, 2, 8);
    const Faces faces = faces_where(67, 35, [](int x, int y) { return (x / 8 + y / 8) % 2 == 0; });
    const ImageDerivatives before = filters.derivatives(images, faces, 2);
    for (std::size_t i = 0; i < images.values.size(); ++i)
        if (faces[i % images.pixels()] == k_no_face) images.values[i] = std::numeric_limits<float>::quiet_NaN();
    const ImageDerivatives after = filters.derivatives(images, faces, 2);
    EXPECT_EQ(before.value, after.value);
    EXPECT_EQ(before.maximum_curvature, after.maximum_curvature);
    EXPECT_EQ(before.orientation_cos, after.orientation_cos);
}

TEST(ImageDerivativesParity, StayOnTheDeviceForSeveralScales) {
    GpuImageFilters filters(shared_device());
    const ImageStack images = random_images(50, 60, 3, 2);
    const Faces faces = faces_where(50, 60, [](int x, int y) { return x + y > 40; });
    const Buffer face = Buffer::of<std::uint32_t>(shared_device(), faces);
    const GpuImages on_device{50, 60, 3, Buffer::of<float>(shared_device(), images.values)};
    const GpuMaskedImages inside = filters.masked(on_device, face);
    EXPECT_EQ(inside.box, mask_box(faces, 50));
    Stream stream(shared_device());
    std::vector<GpuImageDerivatives> results(2);
    filters.record_derivatives(stream, inside, 1, results[0]);
    filters.record_derivatives(stream, inside, 3, results[1]);
    EXPECT_EQ(results[0].fetch(stream).minimum_curvature, filters.derivatives(images, faces, 1).minimum_curvature);
    EXPECT_EQ(results[1].fetch(stream).orientation_sin, filters.derivatives(images, faces, 3).orientation_sin);
}

TEST(ImageDerivativesParity, OrientationsCanBeLeftOut) {
    GpuImageFilters filters(shared_device());
    const ImageStack images = random_images(61, 47, 4, 6);
    const Faces faces = faces_where(61, 47, [](int x, int y) { return x + 2 * y > 30; });
    const ImageDerivatives all = filters.derivatives(images, faces, 2),
                           some = filters.derivatives(images, faces, 2, false);
    EXPECT_EQ(some.value, all.value);
    EXPECT_EQ(some.gradient_y, all.gradient_y);
    EXPECT_EQ(some.minimum_curvature, all.minimum_curvature);
    EXPECT_EQ(some.orientation_cos, ImageStack());
    const ImageDerivatives nothing = filters.derivatives(images, Faces(faces.size(), k_no_face), 2, false);
    EXPECT_EQ(nothing.value, ImageStack(61, 47, 4));
    EXPECT_EQ(nothing.orientation_sin, ImageStack());
}

TEST(ImageDerivativesParity, RerunsAndOtherSizesBetweenThemChangeNothing) {
    GpuImageFilters filters(shared_device());
    const ImageStack images = random_images(61, 47, 2, 4), others = random_images(90, 90, 4, 5);
    const Faces faces = faces_where(61, 47, [](int x, int y) { return (x - 30) * (x - 30) + y * y < 900; });
    const ImageDerivatives first = filters.derivatives(images, faces, 2);
    filters.derivatives(others, Faces(8100, 0), 5);
    filters.blurred(others, 5);
    const ImageDerivatives again = filters.derivatives(images, faces, 2);
    EXPECT_EQ(again.gradient_x, first.gradient_x);
    EXPECT_EQ(again.minimum_curvature, first.minimum_curvature);
    EXPECT_EQ(again.orientation_sin, first.orientation_sin);
}

TEST(ImageDerivativesParity, RefuseWhatTheReferenceRefuses) {
    GpuImageFilters gpu(shared_device());
    CpuImageFilters cpu;
    const Faces faces(12, 0);
    for (ImageFilters* filters : std::initializer_list<ImageFilters*>{&gpu, &cpu}) {
        EXPECT_THROW(filters->derivatives(ImageStack(4, 3, 0), faces, 1), UsageError);
        EXPECT_THROW(filters->derivatives(ImageStack(4, 3, 5), faces, 1), UsageError);
        EXPECT_THROW(filters->derivatives(ImageStack(4, 4, 1), faces, 1), UsageError);
        EXPECT_THROW(filters->derivatives(ImageStack(4, 3, 1), faces, 0), UsageError);
        EXPECT_THROW(filters->blurred(ImageStack(4, 3, 1), 1000), UsageError);
        EXPECT_EQ(filters->derivatives(ImageStack(0, 0, 1), {}, 1).value, ImageStack(0, 0, 1));
        EXPECT_EQ(filters->blurred(ImageStack(4, 3, 0), 5), ImageStack(4, 3, 0));
    }
}

TEST(GaussianBlurParity, OddSizesAndAnyNumberOfImages) {
    GpuImageFilters filters(shared_device());
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(65, 63), std::pair(130, 5), std::pair(3, 129)})
        for (const std::size_t count : {1u, 4u, 6u})
            for (const float sigma : {0.5f, 5.0f, 10.0f, 20.0f}) {
                SCOPED_TRACE(::testing::Message() << width << " x " << height << ", " << count << ", " << sigma);
                const ImageStack images = random_images(width, height, count, count);
                expect_near_images(CpuImageFilters().blurred(images, sigma), filters.blurred(images, sigma),
                                   k_value_tolerance, "blurred");
            }
}

}  // namespace
}  // namespace exemplar
