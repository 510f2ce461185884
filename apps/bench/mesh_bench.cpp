#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/mesh/curvature/curvature.h"
#include "host/mesh/curvature/curvature_estimator.h"
#include "host/mesh/mesh.h"
#include "host/mesh/queries/axes.h"
#include "host/mesh/queries/geodesics.h"
#include "host/mesh/queries/rays.h"
#include "host/mesh/topology.h"

// The geometry operations that features are based on, on one thread, on a bumpy torus. Items are faces (vertices for
// curvature, reached faces for bounded searches, rays for rays), so items per second can be compared between sizes.

namespace exemplar {
namespace {

/// Makes a torus of 2 n m faces with bumps that break all symmetry; triangles vary in size and shape.
TriangleMesh bumpy_torus(std::uint32_t n, std::uint32_t m) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < m; ++j) {
            const float u = 6.2831853f * static_cast<float>(i) / static_cast<float>(n);
            const float v = 6.2831853f * static_cast<float>(j) / static_cast<float>(m);
            const float tube = 1 + 0.2f * std::sin(5 * u + v) + 0.1f * std::cos(3 * v - 2 * u);
            const float w = 3 + 0.3f * std::sin(u) + tube * std::cos(v);
            mesh.vertices.push_back({w * std::cos(u), w * std::sin(u), tube * std::sin(v)});
            const auto at = [&](std::uint32_t a, std::uint32_t b) { return (a % n) * m + b % m; };
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.faces.size());
    return mesh;
}
TriangleMesh mesh_of_20k_faces() {
    return bumpy_torus(170, 59);
}
/// About 10, 20 or 50 thousand vertices.
TriangleMesh mesh_of_vertices(std::int64_t thousands) {
    if (thousands == 10) return bumpy_torus(179, 56);
    return thousands == 20 ? bumpy_torus(250, 80) : bumpy_torus(400, 125);
}

void count_items(benchmark::State& state, std::size_t per_iteration) {
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * per_iteration));
}

void topology(benchmark::State& state) {
    const TriangleMesh mesh = mesh_of_20k_faces();
    for (auto _ : state) benchmark::DoNotOptimize(build_topology(mesh));
    count_items(state, mesh.face_count());
}
BENCHMARK(topology)->Unit(benchmark::kMillisecond);

void dihedral_angles(benchmark::State& state) {
    const TriangleMesh mesh = mesh_of_20k_faces();
    const Topology edges = build_topology(mesh);
    for (auto _ : state) benchmark::DoNotOptimize(exterior_dihedral_angles(mesh, edges));
    count_items(state, mesh.face_count());
}
BENCHMARK(dihedral_angles)->Unit(benchmark::kMillisecond);

void bounded_searches(benchmark::State& state) {
    const TriangleMesh mesh = mesh_of_20k_faces();
    const DualGraph graph = build_dual_graph(mesh, build_topology(mesh));
    GeodesicSearch search(graph);
    const float radius = static_cast<float>(state.range(0)) / 10;
    std::size_t reached = 0, runs = 0;
    std::uint32_t source = 0;
    for (auto _ : state) {
        reached += search.within(source, radius).size();
        source = (source + 1) % static_cast<std::uint32_t>(mesh.face_count());
        ++runs;
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(reached));
    state.counters["faces_per_search"] = static_cast<double>(reached) / static_cast<double>(runs);
}
BENCHMARK(bounded_searches)->Arg(5)->Arg(10)->Arg(20)->Unit(benchmark::kMicrosecond);

void all_distances(benchmark::State& state) {
    const TriangleMesh mesh = mesh_of_20k_faces();
    const DualGraph graph = build_dual_graph(mesh, build_topology(mesh));
    GeodesicSearch search(graph);
    std::vector<float> out(mesh.face_count());
    std::uint32_t source = 0;
    for (auto _ : state) {
        search.distances(source, out);
        source = (source + 77) % static_cast<std::uint32_t>(mesh.face_count());
    }
    count_items(state, mesh.face_count());
}
BENCHMARK(all_distances)->Unit(benchmark::kMillisecond);

void face_samples(benchmark::State& state) {
    const TriangleMesh mesh = mesh_of_20k_faces();
    const DualGraph graph = build_dual_graph(mesh, build_topology(mesh));
    for (auto _ : state) benchmark::DoNotOptimize(sample_faces(mesh, graph, 1000));
    count_items(state, mesh.face_count());
}
BENCHMARK(face_samples)->Unit(benchmark::kMillisecond);

void ray_scene(benchmark::State& state) {
    const TriangleMesh mesh = mesh_of_20k_faces();
    const ThreadLimit one(1);
    for (auto _ : state) benchmark::DoNotOptimize(RayScene(mesh));
    count_items(state, mesh.face_count());
}
BENCHMARK(ray_scene)->Unit(benchmark::kMillisecond);

void rays_inward(benchmark::State& state) {
    const TriangleMesh mesh = mesh_of_20k_faces();
    const RayScene scene(mesh);
    const std::vector<Vec3> centers = face_centers(mesh), normals = face_normals(mesh);
    Random random(1);
    std::vector<Vec3> directions;
    for (const Vec3& n : normals) {
        const Vec3 jitter(static_cast<float>(random.normal()), static_cast<float>(random.normal()),
                          static_cast<float>(random.normal()));
        directions.push_back((0.3f * jitter - n).normalized());
    }
    for (auto _ : state)
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
            benchmark::DoNotOptimize(scene.first_hit_from(f, centers[f], directions[f]));
    count_items(state, mesh.face_count());
}
BENCHMARK(rays_inward)->Unit(benchmark::kMillisecond);

void curvature_once(benchmark::State& state) {
    const TriangleMesh mesh = mesh_of_vertices(20);
    const ThreadLimit one(1);
    for (auto _ : state) benchmark::DoNotOptimize(estimate_curvature(mesh, state.range(0) != 0));
    count_items(state, mesh.vertex_count());
}
BENCHMARK(curvature_once)->ArgName("derivatives")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void curvature_again(benchmark::State& state, const CurvatureOptions& options) {
    const TriangleMesh mesh = mesh_of_vertices(state.range(0));
    const ThreadLimit one(1);
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    estimator.estimate(mesh.vertices, options);  // allocates
    for (auto _ : state) benchmark::DoNotOptimize(estimator.estimate(mesh.vertices, options));
    count_items(state, mesh.vertex_count());
}
#define CURVATURE_AGAIN(name, ...)                                         \
    BENCHMARK_CAPTURE(curvature_again, name, CurvatureOptions __VA_ARGS__) \
        ->ArgName("thousands")                                             \
        ->Arg(10)                                                          \
        ->Arg(20)                                                          \
        ->Arg(50)                                                          \
        ->Unit(benchmark::kMillisecond)
CURVATURE_AGAIN(without_derivatives, {false});
CURVATURE_AGAIN(with_derivatives, {true});
CURVATURE_AGAIN(smoothed_by_1, {true, 1});
CURVATURE_AGAIN(smoothed_by_2, {true, 2});
CURVATURE_AGAIN(cauchy, {true, 0, 0, RobustEstimator::cauchy});
CURVATURE_AGAIN(geman_mcclure, {true, 0, 0, RobustEstimator::geman_mcclure});
#undef CURVATURE_AGAIN

void symmetry(benchmark::State& state) {
    const TriangleMesh mesh = mesh_of_20k_faces();
    const ThreadLimit one(1);
    for (auto _ : state) benchmark::DoNotOptimize(symmetry_planes(mesh));
    count_items(state, mesh.face_count());
}
BENCHMARK(symmetry)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace exemplar
