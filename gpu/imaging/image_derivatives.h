#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gpu/imaging/gaussian_sums.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/image.h"
#include "host/imaging/image_derivatives.h"

namespace exemplar {

/// Images of one size on the device: a float per pixel, row by row, one image after the other.
struct GpuImages {
    int width = 0, height = 0;
    std::uint32_t count = 0;  ///< 1 to k_max_derived_images
    Buffer values;

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    ImageStack download() const;
};

/// Images inside a mask as lanes of one vec4 per pixel, for the part of the image that the mask needs.
struct GpuMaskedImages {
    int width = 0, height = 0;
    std::uint32_t count = 0;
    const Buffer* face = nullptr;  ///< a uint per pixel; must live as long as this is used
    std::optional<PixelBox> box;   ///< empty if no pixel is inside
    Buffer packed;                 ///< a vec4 per pixel of the box, zero outside of the mask
    Buffer inside;                 ///< a float per pixel of the box: 1 or 0
};

/// ImageDerivatives of `count` images on the device: all floats, zero outside of the mask.
struct GpuImageDerivatives {
    int width = 0, height = 0;
    std::uint32_t count = 0;
    Buffer value;        ///< count x pixels
    Buffer gradient;     ///< 2 x count x pixels: x of all images, then y
    Buffer magnitude;    ///< count x pixels: magnitude of the gradients
    Buffer curvature;    ///< 2 x count x pixels: maximum, then minimum
    Buffer orientation;  ///< 2 x count x pixels: cos, then sin of the doubled angle, times the coherence; or empty

    /// Waits for the work that `stream` has recorded, and returns the results.
    ImageDerivatives fetch(Stream& stream) const;
};

/// Filters images on the device. For values from 0 to 1, results agree with those of CpuImageFilters up to float
/// rounding: values and blurred images within 1e-5, gradients within 1e-4 / sigma, curvatures within 1e-4 / sigma^2;
/// orientations within 1e-3 where gradients are above 0.01 per pixel. One thread at a time may use an object.
class GpuImageFilters final : public ImageFilters {
  public:
    explicit GpuImageFilters(Device& device, Profiler* profiler = nullptr);

    /// Throw as ImageFilters documents, and DeviceLimitError if there are more pixels than a kernel can access at
    /// once (4 million for four images if storage buffers have 128 MiB).
    ImageDerivatives derivatives(const ImageStack& images, std::span<const std::uint32_t> face, float sigma,
                                 bool with_orientations = true) override;
    std::vector<ImageStack> blurred(const ImageStack& images, std::span<const float> sigmas) override;
    using ImageFilters::blurred;

    /// Returns the images inside the mask of a G-buffer's faces, for derivatives at several scales. Waits until they
    /// are computed.
    GpuMaskedImages masked(const GpuImages& images, const Buffer& face);
    /// Records the computation of the derivatives; allocates buffers that `out` lacks. Uses buffers of this object,
    /// so streams that run at the same time need one object each.
    void record_derivatives(Stream& stream, const GpuMaskedImages& images, float sigma, GpuImageDerivatives& out,
                            bool with_orientations = true);
    /// Records a convolution with a Gaussian; images are zero outside.
    void record_blur(Stream& stream, const GpuImages& images, float sigma, GpuImages& out);

  private:
    GpuMaskedImages pack(Stream& stream, const GpuImages& images, const Buffer& face, std::optional<PixelBox> box);
    void reserve_planes(const PixelBox& box);
    void sum_mask(Stream& stream, const GpuGaussian& gaussian, const GpuMaskedImages& images);
    void sum_images(Stream& stream, const GpuGaussian& gaussian, const GpuMaskedImages& images);
    void derive(Stream& stream, const GaussianKernel& kernel, const GpuMaskedImages& images, GpuImageDerivatives& out);
    void orient(Stream& stream, const GpuGaussian& gaussian, const GpuMaskedImages& images, GpuImageDerivatives& out);

    Device& device_;
    Stream stream_;
    GaussianSums sums_;
    Kernel box_, pack_, pack_masked_, unpack_, derivatives_, structure_, orientation_;
    // Planes with a vec4 per pixel of the box.
    std::array<Buffer, 4> along_x_;        // sums along x, by the power of the offset
    std::array<Buffer, 6> image_moments_;  // sums of x^i y^j: 00, 10, 01, 20, 11, 02
    std::array<Buffer, 4> mask_moments_;   // sums of x^i y^j of the mask: plane j, lane i
};

}  // namespace exemplar
