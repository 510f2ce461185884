// The kernels that pose an animated surface and estimate its curvature anew (see kernel_bench.h).

#include "apps/bench/surface_bench.h"

#include "gpu/curvature/curvature.h"
#include "gpu/curvature/normals.h"
#include "gpu/curvature/poser.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

void pose(benchmark::State& state) {
    Random random(3);
    const TriangleMesh rest = wavy_torus(static_cast<std::uint32_t>(state.range(0)));
    const Rig rig = chain_rig(rest.vertex_count(), random);
    Pose posed = rest_pose(rig);
    for (NodeTransform& node : posed.nodes) node.rotation = Eigen::AngleAxisf(0.02f, Vec3::UnitZ());
    for (float& weight : posed.weights) weight = static_cast<float>(random.uniform());
    std::vector<Vec3> expected;
    const double reference_ms = reference_cpu([&] { pose_vertices(rig, rest.vertices, posed, expected); });
    Profiler profiler;
    Stream stream(bench().device, &profiler);
    GpuPoser poser(bench().device, rig, rest.vertices);
    const auto call = [&] {
        poser.record(stream, posed);
        stream.finish();
    };
    call();
    // Sums of a few products, relative to the size of the mesh.
    const float size = 1.0f / static_cast<float>(bounding_box(rest).diagonal());
    if (!verified(state, flattened(vectors_of(poser.vertices()), size), flattened(expected, size))) return;

    // Per influence twelve products and sums; the point itself three times four; an offset of a target per vertex.
    const auto vertices = static_cast<double>(rest.vertex_count());
    time_call(state, profiler,
              {.bytes = vertices * (16 + 32 + 4 + 16 + 16), .operations = vertices * (4 * 24 + 24 + 6)}, call);
    state.counters["reference_cpu"] = reference_ms;
}
BENCHMARK(pose)->Apply(three_sizes);

// What the kernels read and write per vertex of six faces, each once, and about how much they calculate per face.
constexpr double k_ring_bytes = 4 + 32, k_normal_operations = 60, k_curvature_operations = 200,
                 k_derivative_operations = 350, k_near_operations = 100;

void normals(benchmark::State& state) {
    const TriangleMesh mesh = wavy_torus(static_cast<std::uint32_t>(state.range(0)));
    std::vector<Vec3> expected;
    const double reference_ms = reference_cpu([&] { expected = vertex_normals(mesh); });
    const GpuSurface surface(bench().device, mesh);
    const Buffer vertices = uploaded(mesh.vertices);
    Profiler profiler;
    Stream stream(bench().device, &profiler);
    GpuNormals device_normals(surface);
    const auto call = [&] {
        device_normals.record(stream, vertices);
        stream.finish();
    };
    call();
    if (!verified(state, flattened(vectors_of(device_normals.normals()), 1), flattened(expected, 1))) return;

    const auto count = static_cast<double>(mesh.vertex_count());
    time_call(state, profiler, {.bytes = count * (k_ring_bytes + 32), .operations = count * 6 * k_normal_operations},
              call);
    state.counters["reference_cpu"] = reference_ms;
}
BENCHMARK(normals)->Apply(three_sizes);

void time_curvature(benchmark::State& state, const CurvatureOptions& options, double near) {
    const TriangleMesh mesh = wavy_torus(static_cast<std::uint32_t>(state.range(0)));
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    VertexCurvature expected;
    const ThreadLimit one_thread(1);
    const double reference_ms = reference_cpu([&] { estimator.estimate(mesh.vertices, options); });
    expected = estimator.estimate(mesh.vertices, options);
    const GpuSurface surface(bench().device, mesh);
    const Buffer vertices = uploaded(mesh.vertices);
    Profiler profiler;
    Stream stream(bench().device, &profiler);
    GpuCurvature curvature(surface, options);
    const auto call = [&] {
        curvature.record(stream, vertices);
        stream.finish();
    };
    call();
    if (!verified(state, curvature, expected)) return;

    const auto count = static_cast<double>(mesh.vertex_count());
    double bytes = 3 * k_ring_bytes + 32 + 64 + 64;
    double operations = 6 * (k_normal_operations + k_curvature_operations + k_derivative_operations);
    if (options.smoothing > 0) {
        bytes += 2 * (4 + 4 * near) + 80 + 80;
        operations += 2 * k_near_operations * near;
    }
    time_call(state, profiler, {.bytes = count * bytes, .operations = count * operations}, call);
    state.counters["reference_cpu"] = reference_ms;
    for (const auto& [kernel, entry] : profiler.entries()) state.counters[kernel] = entry.milliseconds;
}

void curvature(benchmark::State& state) {
    time_curvature(state, {}, 0);
}
BENCHMARK(curvature)->Apply(three_sizes);

// Of a kernel that reaches three median edges far; near vertices, of which there are this many here, are four away.
void smoothed_curvature(benchmark::State& state) {
    constexpr double k_near = 82;
    time_curvature(state, {.smoothing = 1}, k_near);
}
BENCHMARK(smoothed_curvature)->Apply(three_sizes);

}  // namespace
}  // namespace exemplar
