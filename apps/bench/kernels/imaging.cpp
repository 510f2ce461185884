// Image filters, and the pictures of meshes.

#include <cmath>
#include <cstdlib>

#include "apps/bench/kernels/surfaces.h"
#include "embedded/imaging_gbuffer_points_comp.h"
#include "embedded/imaging_image_derivatives_comp.h"
#include "embedded/imaging_mask_box_comp.h"
#include "embedded/imaging_mask_sums_comp.h"
#include "embedded/imaging_orientation_comp.h"
#include "embedded/imaging_pack_comp.h"
#include "embedded/imaging_resolve_comp.h"
#include "embedded/imaging_structure_comp.h"
#include "embedded/imaging_unpack_comp.h"
#include "embedded/imaging_weighted_sums_comp.h"
#include "gpu/imaging/gbuffer_renderer.h"
#include "gpu/imaging/image_derivatives.h"
#include "gpu/imaging/mesh_renderer.h"
#include "host/imaging/raster.h"

namespace exemplar {
namespace {

constexpr float k_sigma = 2;
constexpr std::size_t k_images = 4;

// The side of a square picture.
int side_of(std::size_t pixels) {
    return static_cast<int>(std::lround(std::sqrt(static_cast<double>(pixels))));
}

ImageStack random_images(int side, Random& random) {
    ImageStack images(side, side, k_images);
    for (float& value : images.values) value = static_cast<float>(random.uniform());
    return images;
}

// A disc that nearly fills the picture.
std::vector<std::uint32_t> disc(int side) {
    std::vector<std::uint32_t> faces;
    const double middle = 0.5 * side;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            faces.push_back(std::hypot(x + 0.5 - middle, y + 0.5 - middle) < 0.48 * side ? 1u : k_no_face);
    return faces;
}

// A product and a sum for each weight, pixel and lane of a vec4.
double sum_operations(double pixels) {
    return pixels * (2 * gaussian_kernel(k_sigma).radius + 1) * 4 * 2;
}

// Derivatives of random images, the worst case for floats, in a mask.
struct Derivatives {
    Derivatives(Device& device, Profiler& profiler, std::size_t pixels)
        : images(random_images(side_of(pixels), random)),
          faces(disc(images.width)),
          filters(device, &profiler),
          stream(device, &profiler),
          on_device{images.width, images.height, k_images, Buffer::of<float>(device, images.values)},
          face(Buffer::of<std::uint32_t>(device, faces)) {}
    // The images are on the device already, so the device also finds the bounding box of the mask.
    void run() {
        const GpuMaskedImages inside = filters.masked(on_device, face);
        filters.record_derivatives(stream, inside, k_sigma, derivatives);
        actual = derivatives.fetch(stream);
    }
    std::vector<Difference> differences() const {
        const ImageDerivatives expected = CpuImageFilters().derivatives(images, faces, k_sigma);
        const auto of = [](const char* name, const ImageStack& a, const ImageStack& b, double tolerance) {
            return Difference{name, largest_difference(a.values, b.values), tolerance};
        };
        constexpr double k_first = 1e-4 / k_sigma, k_second = 1e-4 / (k_sigma * k_sigma);
        return {of("values", actual.value, expected.value, 1e-5),
                of("gradients", actual.gradient_x, expected.gradient_x, k_first),
                of("largest curvatures", actual.maximum_curvature, expected.maximum_curvature, k_second),
                {"orientations where steep", orientation_difference(expected), 1e-3}};
    }
    // Ignores gradients below 0.01 per pixel, whose orientations divide by almost zero.
    double orientation_difference(const ImageDerivatives& expected) const {
        double largest = 0;
        for (std::size_t i = 0; i < expected.orientation_cos.values.size(); ++i)
            if (expected.gradient_magnitude.values[i] > 0.01f)
                largest = std::max(largest, static_cast<double>(std::abs(actual.orientation_cos.values[i] -
                                                                         expected.orientation_cos.values[i])));
        return largest;
    }
    std::map<std::string, Work> work() const {
        const auto all = static_cast<double>(faces.size());
        const PixelBox box_of_mask = mask_box(faces, images.width).value();
        const double box = static_cast<double>(box_of_mask.width) * box_of_mask.height;
        // Planes of a vec4 per pixel of the box that passes read + write: along x 1 + 3; along y 1 + 4 (the mask), 1
        // + 3, 1 + 2 and 1 + 1; for tensors six times 1 + 1.
        constexpr double k_planes = (1 + 3) + (1 + 4) + (1 + 3) + (1 + 2) + (1 + 1) + 6 * (1 + 1), k_outputs = 19;
        return {
            {"imaging/mask_box.comp", {.bytes = 4 * all, .operations = 3 * all}},
            {"imaging/pack.comp", {.bytes = box * (4 + 4 * k_images + 16 + 4), .operations = box}},
            {"imaging/mask_sums.comp", {.bytes = box * (4 + 16), .operations = sum_operations(box)}},
            {"imaging/weighted_sums.comp",
             {.bytes = 16 * box * k_planes, .operations = k_outputs * sum_operations(box)}},
            {"imaging/image_derivatives.comp",
             {.bytes = 160 * box + 4 * all + all * k_images * 6 * 4, .operations = box * k_images * 120}},
            {"imaging/structure.comp", {.bytes = box * (2 * 4 * k_images + 3 * 16), .operations = box * k_images * 6}},
            {"imaging/orientation.comp",
             {.bytes = 48 * box + 4 * all + all * 2 * 4 * k_images, .operations = box * k_images * 4}}};
    }
    Random random{5};
    ImageStack images;
    std::vector<std::uint32_t> faces;
    ImageDerivatives actual;
    GpuImageFilters filters;
    Stream stream;
    GpuImages on_device;
    Buffer face;
    GpuImageDerivatives derivatives;
};

struct Blur {
    Blur(Device& device, Profiler& profiler, std::size_t pixels)
        : images(random_images(side_of(pixels), random)), filters(device, &profiler) {}
    void run() { actual = filters.blurred(images, k_sigma); }
    std::vector<Difference> differences() const {
        return {{"values", largest_difference(actual.values, CpuImageFilters().blurred(images, k_sigma).values), 1e-5}};
    }
    std::map<std::string, Work> work() const {
        const auto pixels = static_cast<double>(images.pixels());
        return {{"imaging/pack.comp", {.bytes = pixels * (4 * k_images + 16), .operations = 0}},
                {"imaging/weighted_sums.comp", {.bytes = pixels * 4 * 16, .operations = 2 * sum_operations(pixels)}},
                {"imaging/unpack.comp", {.bytes = pixels * (16 + 4 * k_images), .operations = 0}}};
    }
    Random random{6};
    ImageStack images, actual;
    GpuImageFilters filters;
};

// A torus whose faces are about 250 pixels large.
TriangleMesh pictured_torus(std::size_t pixels) {
    return wavy_torus(static_cast<std::uint32_t>(std::max<std::size_t>(pixels / 500, 64)));
}

// Pixels at edges may differ: D16 in docs/portability.md.
constexpr double k_share_at_edges = 0.04;

struct GBuffers {
    GBuffers(Device& device, Profiler& profiler, std::size_t pixels)
        : side(side_of(pixels)),
          mesh(pictured_torus(pixels)),
          camera(fit_camera(mesh, Vec3(0.3f, 0.8f, 1), 1)),
          renderer(device, 2048, std::size_t{1} << 30, &profiler) {}
    void run() { actual = renderer.render(mesh, camera, side, side); }
    std::vector<Difference> differences() const {
        const GBuffer expected = render_gbuffer(mesh, camera, side, side);
        std::size_t other_face = 0, other_place = 0;
        for (std::size_t p = 0; p < expected.size(); ++p) {
            if (actual.face[p] != expected.face[p])
                ++other_face;
            else if (largest_difference(actual.barycentric[p], expected.barycentric[p]) > 0.01)
                ++other_place;
        }
        const auto share = [&](std::size_t count) {
            return static_cast<double>(count) / static_cast<double>(expected.size());
        };
        return {{"share of pixels with another face", share(other_face), k_share_at_edges},
                {"share of pixels off by a hundredth of a face", share(other_place), 1e-3}};
    }
    // Per pixel its face number is read and 16 bytes are written; per face its corners are read, and each vertex.
    std::map<std::string, Work> work() const {
        const auto pixels = static_cast<double>(actual.size());
        return {{"imaging/gbuffer_points.comp",
                 {.bytes = pixels * (4 + 16) + 16.0 * static_cast<double>(mesh.face_count() + mesh.vertex_count()),
                  .operations = 100 * pixels}}};
    }
    int side;
    TriangleMesh mesh;
    Camera camera;
    GBuffer actual;
    GpuGBufferRenderer renderer;
};

struct Pictures {
    Pictures(Device& device, Profiler& profiler, std::size_t pixels)
        : side(side_of(pixels)),
          mesh(pictured_torus(pixels)),
          colors(mesh.face_count(), Color{200, 120, 60}),
          camera(fit_camera(mesh, Vec3(0.3f, 0.8f, 1), 1)),
          renderer(device, 1024, std::size_t{1} << 30, &profiler) {}
    void run() { actual = renderer.render(mesh, colors, camera, side, side); }
    std::vector<Difference> differences() const {
        const Image expected = render_mesh(mesh, colors, camera, side, side);
        std::size_t other = 0;
        for (std::size_t i = 0; i < expected.data.size(); ++i) other += std::abs(actual.data[i] - expected.data[i]) > 2;
        return {{"share of values off by more than 2 of 255",
                 static_cast<double>(other) / static_cast<double>(expected.data.size()), k_share_at_edges}};
    }
    // Per pixel four samples of 8 bytes are read and 4 bytes written; a power per color channel.
    std::map<std::string, Work> work() const {
        const double pixels = static_cast<double>(side) * side;
        return {{"imaging/resolve.comp", {.bytes = pixels * (4 * 8 + 4), .operations = pixels * 24}}};
    }
    int side;
    TriangleMesh mesh;
    std::vector<Color> colors;
    Camera camera;
    Image actual;
    MeshRenderer renderer;
};

}  // namespace

std::vector<OperationKind> imaging_operations() {
    const std::vector<std::size_t> sizes{65'536, 262'144, 1'048'576};
    return {{"image derivatives",
             "pixels",
             sizes,
             {&shaders::imaging_mask_box_comp, &shaders::imaging_pack_comp, &shaders::imaging_mask_sums_comp,
              &shaders::imaging_weighted_sums_comp, &shaders::imaging_image_derivatives_comp,
              &shaders::imaging_structure_comp, &shaders::imaging_orientation_comp},
             {k_sum_outputs, k_mask_outputs},
             prepare_as<Derivatives>},
            {"Gaussian blur",
             "pixels",
             sizes,
             {&shaders::imaging_pack_comp, &shaders::imaging_weighted_sums_comp, &shaders::imaging_unpack_comp},
             {},
             prepare_as<Blur>},
            {"G-buffer", "pixels", sizes, {&shaders::imaging_gbuffer_points_comp}, {}, prepare_as<GBuffers>},
            {"shaded pictures", "pixels", sizes, {&shaders::imaging_resolve_comp}, {}, prepare_as<Pictures>}};
}

}  // namespace exemplar
