// Posing an animated surface, its normals, and its curvature estimated anew.

#include "gpu/curvature/surface/curvature.h"
#include "apps/bench/kernels/surfaces.h"
#include "embedded/curvature_curvature_comp.h"
#include "embedded/curvature_derivative_comp.h"
#include "embedded/curvature_normals_comp.h"
#include "embedded/curvature_pose_comp.h"
#include "embedded/curvature_smooth_derivatives_comp.h"
#include "embedded/curvature_smooth_forms_comp.h"
#include "gpu/curvature/surface/normals.h"
#include "gpu/curvature/surface/poser.h"

namespace exemplar {
namespace {

struct Posing {
    Posing(Device& device, Profiler& profiler, std::size_t vertices)
        : rest(wavy_torus(static_cast<std::uint32_t>(vertices))),
          rig(chain_rig(rest.vertex_count(), random)),
          posed(rest_pose(rig)),
          stream(device, &profiler),
          poser(device, rig, rest.vertices) {
        for (NodeTransform& node : posed.nodes) node.rotation = Eigen::AngleAxisf(0.02f, Vec3::UnitZ());
        for (float& weight : posed.weights) weight = static_cast<float>(random.uniform());
    }
    void run() {
        poser.record(stream, posed);
        stream.finish();
    }
    std::vector<Difference> differences() const {
        std::vector<Vec3> expected;
        pose_vertices(rig, rest.vertices, posed, expected);
        // Positions are sums of a few products, so they are compared relative to the size of the mesh.
        const float size = 1.0f / static_cast<float>(bounding_box(rest).diagonal());
        return {{"positions, relative to the mesh",
                 largest_difference(flattened(vectors_of(poser.vertices()), size), flattened(expected, size)), 1e-5}};
    }
    // Per influence twelve products and sums; the point itself three times four; an offset of a target per vertex.
    std::map<std::string, Work> work() const {
        const auto vertices = static_cast<double>(rest.vertex_count());
        return {{"curvature/pose.comp",
                 {.bytes = vertices * (16 + 32 + 4 + 16 + 16), .operations = vertices * (4 * 24 + 24 + 6)}}};
    }
    Random random{3};
    TriangleMesh rest;
    Rig rig;
    Pose posed;
    Stream stream;
    GpuPoser poser;
};

// Bytes of topology that kernels read per vertex of six faces, and their approximate operations per face.
constexpr double k_ring_bytes = 4 + 32, k_normal_operations = 60, k_curvature_operations = 200,
                 k_derivative_operations = 350, k_near_operations = 100;
// Number of near vertices of this mesh: diffusion over an edge length reaches three edges far, near vertices are
// within four.
constexpr double k_near = 82;

struct Estimating {
    Estimating(Device& device, Profiler& profiler, std::size_t vertices, const CurvatureOptions& given)
        : mesh(wavy_torus(static_cast<std::uint32_t>(vertices))),
          options(given),
          surface(device, mesh),
          on_device(uploaded(device, mesh.vertices)),
          stream(device, &profiler),
          curvature(surface, options) {}
    void run() {
        curvature.record(stream, on_device);
        stream.finish();
    }
    std::vector<Difference> differences() const {
        CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
        std::vector<Difference> differences = differences_of(curvature, estimator.estimate(mesh.vertices, options));
        differences.push_back(
            {"normals",
             largest_difference(flattened(vectors_of(curvature.normals()), 1), flattened(vertex_normals(mesh), 1)),
             1e-5});
        return differences;
    }
    // Positions, normals, frames, tensors and derivatives are a vec4 each.
    std::map<std::string, Work> work() const {
        const auto count = static_cast<double>(mesh.vertex_count());
        const auto of = [&](double bytes, double operations) {
            return Work{.bytes = count * bytes, .operations = count * operations};
        };
        std::map<std::string, Work> work{
            {"curvature/normals.comp", of(k_ring_bytes + 16 + 16, 6 * k_normal_operations)},
            {"curvature/curvature.comp", of(k_ring_bytes + 32 + 32, 6 * k_curvature_operations)},
            {"curvature/derivative.comp", of(k_ring_bytes + 48 + 16, 6 * k_derivative_operations)}};
        if (options.smoothing > 0) {
            work["curvature/smooth_forms.comp"] = of(4 + 4 * k_near + 48 + 32, k_near_operations * k_near);
            work["curvature/smooth_derivatives.comp"] = of(4 + 4 * k_near + 64 + 16, k_near_operations * k_near);
        }
        return work;
    }
    TriangleMesh mesh;
    CurvatureOptions options;
    GpuSurface surface;
    Buffer on_device;
    Stream stream;
    GpuCurvature curvature;
};

struct Estimated : Estimating {
    Estimated(Device& device, Profiler& profiler, std::size_t vertices) : Estimating(device, profiler, vertices, {}) {}
};
struct Smoothed : Estimating {
    Smoothed(Device& device, Profiler& profiler, std::size_t vertices)
        : Estimating(device, profiler, vertices, {.smoothing = 1}) {}
};

}  // namespace

std::vector<OperationKind> curvature_operations() {
    const std::vector<std::size_t> sizes{5'000, 20'000, 100'000};
    return {
        {"posing", "vertices", sizes, {&shaders::curvature_pose_comp}, {}, prepare_as<Posing>},
        {"estimated curvature",
         "vertices",
         sizes,
         {&shaders::curvature_normals_comp, &shaders::curvature_curvature_comp, &shaders::curvature_derivative_comp},
         {},
         prepare_as<Estimated>},
        {"smoothed curvature",
         "vertices",
         sizes,
         {&shaders::curvature_normals_comp, &shaders::curvature_curvature_comp, &shaders::curvature_derivative_comp,
          &shaders::curvature_smooth_forms_comp, &shaders::curvature_smooth_derivatives_comp},
         {},
         prepare_as<Smoothed>}};
}

}  // namespace exemplar
