#include "gpu/imaging/image_derivatives.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "embedded/imaging_image_derivatives_comp.h"
#include "embedded/imaging_mask_box_comp.h"
#include "embedded/imaging_orientation_comp.h"
#include "embedded/imaging_pack_comp.h"
#include "embedded/imaging_structure_comp.h"
#include "embedded/imaging_unpack_comp.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/imaging/scan_conversion.h"
#include "shaders/shared/image_filters.h"

namespace exemplar {
namespace {

using shared::DerivativeParameters;
using shared::ImageParameters;
using shared::OrientationParameters;
using shared::vec4;
using Axis = GaussianSums::Axis;

static_assert(shared::k_filter_no_face == k_no_face && shared::k_filter_images == k_max_derived_images);

using Word = std::uint32_t;

// Pixels of a column per invocation of mask_box.comp. A barrier of a CPU driver takes as long as many pixels (D7 in
// docs/portability.md), and the iterations stay below those of D1.
constexpr Word k_box_rows_on_cpus = 1024, k_box_rows_on_cards = 32;

// Makes a kernel whose push constants are Parameters and whose buffers have elements of these types.
template <typename Parameters, typename... Elements>
Kernel kernel_of(Device& device, const Shader& shader, std::vector<std::pair<Word, Word>> constants = {}) {
    return {device,
            shader,
            {.push_constants = layout_of<Parameters>(),
             .elements = {layout_of<Elements>()...},
             .constants = std::move(constants)}};
}

Kernel pack_kernel(Device& device, bool masked) {
    return kernel_of<ImageParameters, float, Word, vec4, float>(device, shaders::imaging_pack_comp, {{0, masked}});
}

Kernel derivative_kernel(Device& device) {
    return kernel_of<DerivativeParameters, vec4, vec4, vec4, vec4, vec4, vec4, vec4, vec4, vec4, vec4, Word, float,
                     float, float, float>(device, shaders::imaging_image_derivatives_comp);
}

ImageParameters parameters_of(int width, int height, Word count, const PixelBox& box) {
    return {.width = static_cast<Word>(width),
            .height = static_cast<Word>(height),
            .box_x = static_cast<Word>(box.x),
            .box_y = static_cast<Word>(box.y),
            .box_width = static_cast<Word>(box.width),
            .box_height = static_cast<Word>(box.height),
            .images = count,
            .rows = 0};
}

ImageParameters parameters_of(const GpuMaskedImages& images) {
    return parameters_of(images.width, images.height, images.count, images.box.value());
}

std::size_t plane_bytes(const PixelBox& box) {
    return static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height) * sizeof(vec4);
}

GaussianSums::Size size_of(const PixelBox& box) {
    return {static_cast<Word>(box.width), static_cast<Word>(box.height)};
}

Threads pixels_of(const PixelBox& box) {
    return {static_cast<Word>(box.width), static_cast<Word>(box.height)};
}

PixelBox whole(int width, int height) {
    return {0, 0, width, height};
}

// Records the upload of some of the images.
GpuImages upload(Device& device, Stream& stream, const ImageStack& images, std::size_t first, std::size_t count) {
    const auto values = std::span(images.values).subspan(first * images.pixels(), count * images.pixels());
    return {images.width, images.height, static_cast<Word>(count), uploaded(device, stream, values)};
}

// Makes a stack for number `place` of a buffer's equal stacks, and adds what it is to read to `parts`.
ImageStack readback(const Buffer& buffer, const GpuImageDerivatives& of, std::size_t place,
                    std::vector<BufferReadback>& parts) {
    ImageStack stack(of.width, of.height, of.count);
    const std::span<std::byte> target = std::as_writable_bytes(std::span(stack.values));
    parts.push_back({&buffer, place * target.size(), target});
    return stack;
}

}  // namespace

ImageStack GpuImages::download() const {
    ImageStack stack(width, height, count);
    values.download<float>(stack.values);
    return stack;
}

ImageDerivatives GpuImageDerivatives::fetch(Stream& stream) const {
    std::vector<BufferReadback> parts;
    const auto stack = [&](const Buffer& buffer, std::size_t place) { return readback(buffer, *this, place, parts); };
    const bool oriented = orientation.bytes() > 0;
    ImageDerivatives result{.value = stack(value, 0),
                            .gradient_x = stack(gradient, 0),
                            .gradient_y = stack(gradient, 1),
                            .gradient_magnitude = stack(magnitude, 0),
                            .maximum_curvature = stack(curvature, 0),
                            .minimum_curvature = stack(curvature, 1),
                            .orientation_cos = oriented ? stack(orientation, 0) : ImageStack(),
                            .orientation_sin = oriented ? stack(orientation, 1) : ImageStack()};
    stream.fetch(parts);
    return result;
}

GpuImageFilters::GpuImageFilters(Device& device, Profiler* profiler)
    : device_(device),
      stream_(device, profiler),
      sums_(device),
      box_(kernel_of<ImageParameters, Word, Word>(device, shaders::imaging_mask_box_comp)),
      pack_(pack_kernel(device, false)),
      pack_masked_(pack_kernel(device, true)),
      unpack_(kernel_of<ImageParameters, vec4, float>(device, shaders::imaging_unpack_comp)),
      derivatives_(derivative_kernel(device)),
      structure_(kernel_of<ImageParameters, float, vec4, vec4, vec4>(device, shaders::imaging_structure_comp)),
      orientation_(
          kernel_of<OrientationParameters, vec4, vec4, vec4, Word, float>(device, shaders::imaging_orientation_comp)) {}

// One submission: the mask's box is found on the host, which has the mask.
ImageDerivatives GpuImageFilters::derivatives(const ImageStack& images, std::span<const std::uint32_t> face,
                                              float sigma, bool with_orientations) {
    check_derivatives(images, face);
    const Buffer faces = uploaded(device_, stream_, face);
    const GpuImages on_device = upload(device_, stream_, images, 0, images.count);
    const GpuMaskedImages inside = pack(stream_, on_device, faces, mask_box(face, images.width));
    GpuImageDerivatives out;
    record_derivatives(stream_, inside, sigma, out, with_orientations);
    return out.fetch(stream_);
}

// One submission for every k_max_derived_images images.
std::vector<ImageStack> GpuImageFilters::blurred(const ImageStack& images, std::span<const float> sigmas) {
    std::vector<ImageStack> out(sigmas.size(), ImageStack(images.width, images.height, images.count));
    std::vector<GpuImages> blurred_images(sigmas.size());
    for (std::size_t first = 0; first < images.count; first += k_max_derived_images) {
        const std::size_t count = std::min(k_max_derived_images, images.count - first);
        const GpuImages some = upload(device_, stream_, images, first, count);
        std::vector<BufferReadback> parts;
        for (std::size_t s = 0; s < sigmas.size(); ++s) {
            record_blur(stream_, some, sigmas[s], blurred_images[s]);
            const std::span values(out[s].values);
            parts.push_back({&blurred_images[s].values, 0,
                             std::as_writable_bytes(values.subspan(first * images.pixels(), count * images.pixels()))});
        }
        stream_.fetch(parts);
    }
    return out;
}

GpuMaskedImages GpuImageFilters::masked(const GpuImages& images, const Buffer& face) {
    // Left, top, right and bottom; the latter two are exclusive.
    std::array<Word, 4> bounds{static_cast<Word>(images.width), static_cast<Word>(images.height), 0, 0};
    const Buffer device_bounds = uploaded<Word>(device_, stream_, bounds);
    const auto width = static_cast<Word>(images.width), height = static_cast<Word>(images.height);
    ImageParameters parameters = parameters_of(images.width, images.height, images.count, {});
    parameters.rows = device_.runs_card_kernels() ? k_box_rows_on_cards : k_box_rows_on_cpus;
    stream_.dispatch(box_, Threads(width, (height + parameters.rows - 1) / parameters.rows), {face, device_bounds},
                     parameters);
    stream_.fetch<Word>(device_bounds, bounds);
    std::optional<PixelBox> box;
    if (bounds[2] != 0)
        box = PixelBox{.x = static_cast<int>(bounds[0]),
                       .y = static_cast<int>(bounds[1]),
                       .width = static_cast<int>(bounds[2] - bounds[0]),
                       .height = static_cast<int>(bounds[3] - bounds[1])};
    GpuMaskedImages out = pack(stream_, images, face, box);
    stream_.finish();
    return out;
}

// Records the packing of the images inside the mask.
GpuMaskedImages GpuImageFilters::pack(Stream& stream, const GpuImages& images, const Buffer& face,
                                      std::optional<PixelBox> box) {
    GpuMaskedImages out{.width = images.width,
                        .height = images.height,
                        .count = images.count,
                        .face = &face,
                        .box = box,
                        .packed = {},
                        .inside = {}};
    if (!box) return out;
    out.packed = Buffer(device_, plane_bytes(*box));
    out.inside = Buffer(device_, plane_bytes(*box) / 4);
    stream.dispatch(pack_masked_, pixels_of(*box), {images.values, face, out.packed, out.inside}, parameters_of(out));
    return out;
}

void GpuImageFilters::record_derivatives(Stream& stream, const GpuMaskedImages& images, float sigma,
                                         GpuImageDerivatives& out, bool with_orientations) {
    const GpuGaussian gaussian(device_, stream, sigma);
    out.width = images.width;
    out.height = images.height;
    out.count = images.count;
    const std::size_t bytes =
        static_cast<std::size_t>(images.width) * static_cast<std::size_t>(images.height) * images.count * sizeof(float);
    for (Buffer* buffer : {&out.value, &out.magnitude}) reserve(device_, *buffer, bytes);
    for (Buffer* buffer : {&out.gradient, &out.curvature}) reserve(device_, *buffer, 2 * bytes);
    if (with_orientations)
        reserve(device_, out.orientation, 2 * bytes);
    else
        out.orientation = {};
    if (!images.box) {
        for (const Buffer* buffer : {&out.value, &out.magnitude, &out.gradient, &out.curvature})
            stream.fill(*buffer, 0);
        if (with_orientations) stream.fill(out.orientation, 0);
        return;
    }
    reserve_planes(*images.box);
    sum_mask(stream, gaussian, images);
    sum_images(stream, gaussian, images);
    derive(stream, gaussian.kernel, images, out);
    if (with_orientations) orient(stream, gaussian, images, out);
}

void GpuImageFilters::record_blur(Stream& stream, const GpuImages& images, float sigma, GpuImages& out) {
    const GpuGaussian gaussian(device_, stream, sigma);
    const PixelBox box = whole(images.width, images.height);
    const ImageParameters parameters = parameters_of(images.width, images.height, images.count, box);
    out.width = images.width;
    out.height = images.height;
    out.count = images.count;
    reserve(device_, out.values, images.pixels() * images.count * sizeof(float));
    for (std::size_t i = 0; i < 2; ++i) reserve(device_, along_x_[i], plane_bytes(box));
    const Buffer &image = along_x_[0], &half_done = along_x_[1];
    // This variant neither reads nor writes a mask, but buffers must be bound.
    stream.dispatch(pack_, pixels_of(box), {images.values, images.values, image, image}, parameters);
    sums_.record(stream, gaussian, Axis::x, size_of(box), image, std::array{&half_done});
    sums_.record(stream, gaussian, Axis::y, size_of(box), half_done, std::array{&image});
    stream.dispatch(unpack_, pixels_of(box), {image, out.values}, parameters);
}

void GpuImageFilters::reserve_planes(const PixelBox& box) {
    for (Buffer& plane : along_x_) reserve(device_, plane, plane_bytes(box));
    for (Buffer& plane : image_moments_) reserve(device_, plane, plane_bytes(box));
    for (Buffer& plane : mask_moments_) reserve(device_, plane, plane_bytes(box));
}

void GpuImageFilters::sum_mask(Stream& stream, const GpuGaussian& gaussian, const GpuMaskedImages& images) {
    const GaussianSums::Size size = size_of(*images.box);
    sums_.record_mask(stream, gaussian, size, images.inside, along_x_[0]);
    sums_.record(stream, gaussian, Axis::y, size, along_x_[0],
                 std::array{&mask_moments_[0], &mask_moments_[1], &mask_moments_[2], &mask_moments_[3]});
}

void GpuImageFilters::sum_images(Stream& stream, const GpuGaussian& gaussian, const GpuMaskedImages& images) {
    const GaussianSums::Size size = size_of(*images.box);
    const auto& [m00, m10, m01, m20, m11, m02] = image_moments_;
    const auto& [x0, x1, x2, unused] = along_x_;
    sums_.record(stream, gaussian, Axis::x, size, images.packed, std::array{&x0, &x1, &x2});
    sums_.record(stream, gaussian, Axis::y, size, x0, std::array{&m00, &m01, &m02});
    sums_.record(stream, gaussian, Axis::y, size, x1, std::array{&m10, &m11});
    sums_.record(stream, gaussian, Axis::y, size, x2, std::array{&m20});
}

void GpuImageFilters::derive(Stream& stream, const GaussianKernel& kernel, const GpuMaskedImages& images,
                             GpuImageDerivatives& out) {
    const CumulantUnits units = cumulant_units(kernel);
    const DerivativeParameters parameters{.image = parameters_of(images),
                                          .inverse_sigma = 1 / kernel.sigma,
                                          .unit_xx = static_cast<float>(units.xx),
                                          .unit_xy = static_cast<float>(units.xy),
                                          .min_spread = k_min_spread};
    const auto& [m00, m10, m01, m20, m11, m02] = image_moments_;
    const auto& [y0, y1, y2, y3] = mask_moments_;
    stream.dispatch(derivatives_, pixels_of(whole(images.width, images.height)),
                    {m00, m10, m01, m20, m11, m02, y0, y1, y2, y3, *images.face, out.value, out.gradient, out.magnitude,
                     out.curvature},
                    parameters);
}

// The moments are no longer needed, so their planes hold the structure tensors, first of pixels, then smoothed.
void GpuImageFilters::orient(Stream& stream, const GpuGaussian& gaussian, const GpuMaskedImages& images,
                             GpuImageDerivatives& out) {
    const ImageParameters image = parameters_of(images);
    const Buffer &trace = image_moments_[0], &difference = image_moments_[1], &product = image_moments_[2];
    stream.dispatch(structure_, pixels_of(*images.box), {out.gradient, trace, difference, product}, image);
    for (const Buffer* plane : {&trace, &difference, &product}) {
        sums_.record(stream, gaussian, Axis::x, size_of(*images.box), *plane, std::array{&along_x_[0]});
        sums_.record(stream, gaussian, Axis::y, size_of(*images.box), along_x_[0], std::array{plane});
    }
    const OrientationParameters parameters{
        .image = image, .noise = k_min_gradient * k_min_gradient, .unused0 = 0, .unused1 = 0, .unused2 = 0};
    stream.dispatch(orientation_, pixels_of(whole(images.width, images.height)),
                    {trace, difference, product, *images.face, out.orientation}, parameters);
}

}  // namespace exemplar
