#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gpu/curvature/curvature.h"
#include "gpu/curvature/learned_curvature.h"
#include "gpu/curvature/normals.h"
#include "gpu/curvature/poser.h"
#include "gpu/labeling/context_histograms.h"
#include "gpu/learn/stump_scorer.h"
#include "gpu/runtime/device.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/core/stopwatch.h"
#include "host/curvature/model_builder.h"
#include "host/curvature/tiling.h"

// The kernels of labeling and of animated surfaces on the device of EXEMPLAR_DEVICE, else the best: each is compared
// with its CPU reference once, then timed by the device's own timestamps. The argument is the number of faces, of
// animated surfaces that of vertices. Counters, per call:
//   MB       what must cross the memory at least: every input once, every output once
//   Mop      additions, comparisons and selections that the result needs, 10^6
//   GB/s, Gop/s       these by device time
//   copy, fma         and as shares of the device's measured ceilings (one multiply-add counts as two operations)
//   call, call_cpu    milliseconds of the whole call with its transfers: wall clock, and CPU of this process
//   reference_cpu     milliseconds of CPU of the reference, on one thread where it is of an animated surface
//   entries           of learned curvature: components that matter to a tile, per attribute

namespace exemplar {
namespace {

constexpr float k_tolerance = 1e-5f;
constexpr std::uint32_t k_classes = 8;

struct Bench {
    Device device;
    Ceilings ceilings = measure_ceilings(device);
};

Bench& bench() {
    static Bench instance;
    return instance;
}

// The least work of one call.
struct Work {
    double bytes = 0.0;
    double operations = 0.0;
};

// Whether device and reference agree; if not, the benchmark reports it instead of a time.
bool verified(benchmark::State& state, const std::vector<float>& actual, const std::vector<float>& expected) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (std::abs(actual[i] - expected[i]) <= k_tolerance) continue;
        state.SkipWithError(fmt::format("value {} is {}, but the reference has {}", i, actual[i], expected[i]).c_str());
        return false;
    }
    return true;
}

// Times `call`, whose dispatches `profiler` sees, by the device's clock.
template <typename Call>
void time_call(benchmark::State& state, Profiler& profiler, const Work& work, Call&& call) {
    double device_ms = 0.0;
    const Stopwatch watch;
    for (auto _ : state) {
        profiler.reset();
        call();
        double milliseconds = 0.0;
        for (const auto& [kernel, entry] : profiler.entries()) milliseconds += entry.milliseconds;
        state.SetIterationTime(1e-3 * milliseconds);
        device_ms += milliseconds;
    }
    const auto calls = static_cast<double>(state.iterations());
    const double seconds = 1e-3 * device_ms / calls;
    const Ceilings& ceilings = bench().ceilings;
    state.counters["MB"] = 1e-6 * work.bytes;
    state.counters["Mop"] = 1e-6 * work.operations;
    state.counters["GB/s"] = 1e-9 * work.bytes / seconds;
    state.counters["Gop/s"] = 1e-9 * work.operations / seconds;
    state.counters["copy"] = 1e-9 * work.bytes / seconds / ceilings.copy_gb_per_s;
    state.counters["fma"] = 1e-9 * work.operations / seconds / ceilings.fma_gflop_per_s;
    state.counters["call"] = 1e3 * watch.wall() / calls;
    state.counters["call_cpu"] = 1e3 * watch.cpu() / calls;
}

// CPU milliseconds of the second of two calls: the first fills caches.
template <typename Call>
double reference_cpu(Call&& call) {
    call();
    const Stopwatch watch;
    call();
    return 1e3 * watch.cpu();
}

FeatureMatrix random_features(std::size_t rows, std::size_t columns, Random& random) {
    FeatureMatrix features;
    features.rows = rows;
    features.values.reserve(rows * columns);
    for (std::size_t c = 0; c < columns; ++c)
        for (float& value : features.add(std::to_string(c))) value = static_cast<float>(random.normal());
    return features;
}

// 300 stumps on 150 of the features, shared by 40 sets of classes: the size of a trained classifier.
BoostedStumps random_stumps(std::size_t columns, Random& random) {
    BoostedStumps classifier{.class_count = k_classes, .stumps = {}, .elsewhere = {}};
    std::array<std::uint64_t, 40> sets;
    for (std::uint64_t& set : sets) set = 1 + random.index((1u << k_classes) - 1);
    for (std::size_t m = 0; m < 300; ++m)
        classifier.stumps.push_back({static_cast<std::uint32_t>(random.index(columns)),
                                     static_cast<float>(random.normal()), static_cast<float>(random.uniform(-0.2, 0.2)),
                                     static_cast<float>(random.uniform(-0.2, 0.2)), sets[random.index(sets.size())]});
    classifier.elsewhere.assign(classifier.stumps.size() * k_classes, 0.0f);
    return classifier;
}

void score_stumps(benchmark::State& state) {
    constexpr std::size_t k_columns = 150;
    Random random(1);
    const FeatureMatrix features = random_features(static_cast<std::size_t>(state.range(0)), k_columns, random);
    const BoostedStumps classifier = random_stumps(k_columns, random);
    std::vector<float> expected(features.rows * k_classes), actual(expected.size());
    CpuStumpScorer reference;
    const double reference_ms =
        reference_cpu([&] { reference.probabilities(classifier, features, Link::softmax, 1.0f, expected); });
    Profiler profiler;
    GpuStumpScorer scorer(bench().device, &profiler);
    const auto call = [&] { scorer.probabilities(classifier, features, Link::softmax, 1.0f, actual); };
    call();
    if (!verified(state, actual, expected)) return;

    const auto rows = static_cast<double>(features.rows), stumps = static_cast<double>(classifier.stumps.size());
    // Per stump a comparison, a selection and a sum; per class a maximum, a difference, exp, a sum and a quotient.
    time_call(
        state, profiler,
        {.bytes = 4 * rows * (k_columns + k_classes) + 16 * stumps, .operations = rows * (3 * stumps + 5 * k_classes)},
        call);
    state.counters["reference_cpu"] = reference_ms;
}
BENCHMARK(score_stumps)->Arg(5'000)->Arg(20'000)->Arg(100'000)->UseManualTime()->Unit(benchmark::kMillisecond);

ContextGeometry random_geometry(std::size_t faces, std::size_t samples, Random& random) {
    ContextGeometry geometry;
    geometry.faces = faces;
    for (std::size_t j = 0; j < samples; ++j)
        geometry.sample_face.push_back(static_cast<std::uint32_t>(random.index(faces)));
    geometry.sample_area.assign(samples, 1.0f / static_cast<float>(samples));
    geometry.geodesic_bin.resize(samples * faces);
    for (std::uint8_t& bin : geometry.geodesic_bin) bin = static_cast<std::uint8_t>(random.next() % k_context_bins);
    geometry.axis_position.resize(k_context_axes * faces);
    for (float& position : geometry.axis_position) position = static_cast<float>(random.uniform(0.0, 2.0));
    for (auto& edges : geometry.axis_edges) edges = {0.2f, 0.5f, 0.95f, 1.5f};
    return geometry;
}

void context_histograms(benchmark::State& state) {
    constexpr std::size_t k_samples = 1000;
    const auto face_count = static_cast<std::size_t>(state.range(0));
    Random random(2);
    const ContextGeometry geometry = random_geometry(face_count, k_samples, random);
    const std::vector<float> probabilities(face_count * k_classes, 1.0f / k_classes);
    constexpr std::size_t k_columns = k_context_measures * k_context_bins * k_classes;
    std::vector<float> expected(k_columns * face_count), actual(expected.size());
    CpuContextHistograms reference;
    const double reference_ms =
        reference_cpu([&] { reference.accumulate(geometry, probabilities, k_classes, expected); });
    Profiler profiler;
    GpuContextHistograms histograms(bench().device, &profiler);
    const auto call = [&] { histograms.accumulate(geometry, probabilities, k_classes, actual); };
    call();
    if (!verified(state, actual, expected)) return;

    // Geodesic ranges: a sum per sample and class. Axes: two binary searches per inner edge, three sums per bin and
    // class.
    const auto faces = static_cast<double>(face_count);
    const double searches = k_context_axes * 2 * (k_context_bins - 1) * std::log2(k_samples);
    time_call(state, profiler,
              {.bytes = faces * (k_samples + 4 * k_context_axes + 4 * k_columns),
               .operations =
                   faces * (k_samples * k_classes + 2 * searches + k_context_axes * k_context_bins * k_classes * 3)},
              call);
    state.counters["reference_cpu"] = reference_ms;
}
BENCHMARK(context_histograms)->Arg(5'000)->Arg(20'000)->Arg(100'000)->UseManualTime()->Unit(benchmark::kMillisecond);

// A wavy torus of twice as many faces as vertices, its edges about 1 long, so that rounding is about the same in all
// sizes.
TriangleMesh wavy_torus(std::uint32_t vertices) {
    const auto around = static_cast<std::uint32_t>(std::sqrt(vertices / 2.0)), along = vertices / around;
    TriangleMesh mesh;
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % along * around + j % around; };
    const double ring = along / (2 * std::numbers::pi), tube = around / (2 * std::numbers::pi);
    for (std::uint32_t i = 0; i < along; ++i)
        for (std::uint32_t j = 0; j < around; ++j) {
            const double u = i / ring, v = j / tube, w = 2 * ring + tube * std::cos(v) * (1 + 0.1 * std::sin(5 * u));
            mesh.vertices.push_back(Vec3d(w * std::cos(u), w * std::sin(u), tube * std::sin(v)).cast<float>());
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

// A chain of 60 bones, four on each vertex, and 20 targets that move a twentieth of the vertices each.
Rig chain_rig(std::size_t vertices, Random& random) {
    Rig rig;
    for (std::uint32_t b = 0; b < 60; ++b) {
        rig.nodes.push_back({std::to_string(b), b == 0 ? k_none : b - 1, {.translation = Vec3(0.1f, 0, 0)}});
        rig.bones.push_back({b, Affine::Identity()});
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        rig.influence_begin.push_back(static_cast<std::uint32_t>(rig.influences.size()));
        const auto first = static_cast<std::uint32_t>(v * 57 / vertices);
        for (std::uint32_t b = first; b < first + 4; ++b) rig.influences.push_back({b, 0.25f});
    }
    rig.influence_begin.push_back(static_cast<std::uint32_t>(rig.influences.size()));
    for (std::size_t t = 0; t < 20; ++t) {
        MorphTarget target{.name = std::to_string(t), .vertices = {}, .offsets = {}};
        for (std::uint32_t v = 0; v < vertices; ++v)
            if (random.uniform() < 0.05) {
                target.vertices.push_back(v);
                target.offsets.emplace_back(0.1f, 0.2f, 0.3f);
            }
        rig.targets.push_back(std::move(target));
    }
    return rig;
}

std::vector<float> flattened(std::span<const Vec3> vectors, float scale) {
    std::vector<float> values;
    values.reserve(3 * vectors.size());
    for (const Vec3& v : vectors) values.insert(values.end(), {scale * v.x(), scale * v.y(), scale * v.z()});
    return values;
}

std::vector<shared::vec4> downloaded(const Buffer& buffer) {
    std::vector<shared::vec4> values(buffer.bytes() / sizeof(shared::vec4));
    buffer.download(std::span(values));
    return values;
}

std::vector<Vec3> vectors_of(const Buffer& buffer) {
    std::vector<Vec3> vectors;
    vectors.reserve(buffer.bytes() / sizeof(shared::vec4));
    for (const shared::vec4& v : downloaded(buffer)) vectors.emplace_back(v.x, v.y, v.z);
    return vectors;
}

Buffer uploaded(std::span<const Vec3> vertices) {
    std::vector<shared::vec4> values;
    values.reserve(vertices.size());
    for (const Vec3& v : vertices) values.push_back({v.x(), v.y(), v.z(), 1.0f});
    return Buffer::of<shared::vec4>(bench().device, values);
}

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
BENCHMARK(pose)->Arg(5'000)->Arg(20'000)->Arg(100'000)->UseManualTime()->Unit(benchmark::kMillisecond);

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
BENCHMARK(normals)->Arg(5'000)->Arg(20'000)->Arg(100'000)->UseManualTime()->Unit(benchmark::kMillisecond);

// The forms as matrices, row by row, whose values do not depend on the signs of principal directions.
std::vector<float> forms(const VertexCurvature& c) {
    std::vector<float> values;
    values.reserve(9 * c.k1.size());
    for (std::size_t v = 0; v < c.k1.size(); ++v) {
        const Eigen::Matrix3f form = c.k1[v] * c.e1[v] * c.e1[v].transpose() + c.k2[v] * c.e2[v] * c.e2[v].transpose();
        values.insert(values.end(), form.data(), form.data() + 9);
    }
    return values;
}

// The squared size of the derivative, which does not depend on the frame either.
std::vector<float> derivative_sizes(std::span<const std::array<float, 4>> derivatives) {
    std::vector<float> values;
    values.reserve(derivatives.size());
    for (const auto& d : derivatives) values.push_back(d[0] * d[0] + 3 * d[1] * d[1] + 3 * d[2] * d[2] + d[3] * d[3]);
    return values;
}

template <typename DeviceCurvature>
VertexCurvature downloaded(const DeviceCurvature& curvature) {
    VertexCurvature result;
    result.e1 = vectors_of(curvature.first());
    result.e2 = vectors_of(curvature.second());
    for (const shared::vec4& v : downloaded(curvature.first())) result.k1.push_back(v.w);
    for (const shared::vec4& v : downloaded(curvature.second())) result.k2.push_back(v.w);
    for (const shared::vec4& v : downloaded(curvature.derivative())) result.derivative.push_back({v.x, v.y, v.z, v.w});
    return result;
}

template <typename DeviceCurvature>
bool verified(benchmark::State& state, const DeviceCurvature& curvature, const VertexCurvature& expected) {
    const VertexCurvature actual = downloaded(curvature);
    return verified(state, forms(actual), forms(expected)) &&
           verified(state, derivative_sizes(actual.derivative), derivative_sizes(expected.derivative));
}

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
BENCHMARK(curvature)->Arg(5'000)->Arg(20'000)->Arg(100'000)->UseManualTime()->Unit(benchmark::kMillisecond);

// Of a kernel that reaches three median edges far; near vertices, of which there are this many here, are four away.
void smoothed_curvature(benchmark::State& state) {
    constexpr double k_near = 82;
    time_curvature(state, {.smoothing = 1}, k_near);
}
BENCHMARK(smoothed_curvature)->Arg(5'000)->Arg(20'000)->Arg(100'000)->UseManualTime()->Unit(benchmark::kMillisecond);

// How many components matter to a vertex.
struct Density {
    std::size_t controls;    // that move its part of the surface
    std::size_t components;  // of each control and attribute
};

Eigen::MatrixXf random_matrix(std::size_t rows, std::size_t columns, float deviation, Random& random) {
    return Eigen::MatrixXf::NullaryExpr(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns),
                                        [&] { return deviation * static_cast<float>(random.normal()); });
}

// A control per node.
StateReader chain_state(const Rig& rig) {
    StateReader state;
    state.kind = AnimationKind::skeleton;
    for (std::uint32_t n = 0; n < rig.nodes.size(); ++n) {
        state.nodes.push_back(n);
        state.reference.push_back(Eigen::Quaternionf::Identity());
        state.controls.push_back({rig.nodes[n].name, 3 * n, 3});
    }
    state.input_count = 3 * rig.nodes.size();
    return state;
}

// All monomials of up to third order of the three inputs of a control.
std::vector<Monomial> cubic_monomials(std::uint32_t first_input, std::uint32_t one) {
    const std::array inputs{first_input, first_input + 1, first_input + 2, one};
    std::vector<Monomial> monomials;
    for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = a; b < 4; ++b)
            for (std::size_t c = b; c < 4; ++c) monomials.push_back({inputs[a], inputs[b], inputs[c]});
    return monomials;
}

// Tensors along the first edge of some face.
AttributeFrames first_edges(const TriangleMesh& mesh) {
    AttributeFrames frames;
    frames.neighbor.resize(mesh.vertex_count());
    for (const Face& face : mesh.faces)
        for (std::size_t i = 0; i < 3; ++i) frames.neighbor[face[i]] = face[(i + 1) % 3];
    return frames;
}

// The poses near which nothing is out of range.
PoseRange unit_range(const StateReader& state) {
    PoseRange range;
    range.mean = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(state.input_count));
    range.whitening.assign(state.controls.size(), Eigen::Matrix3f::Identity());
    range.largest.assign(state.controls.size(), 1.0f);
    return range;
}

// A model of random bases that matter where the controls of a chain_rig would.
CurvatureModel chain_model(const TriangleMesh& rest, const Rig& rig, const Density& density, Random& random) {
    CurvatureModel model;
    model.kind = AnimationKind::skeleton;
    model.vertex_count = rest.vertex_count();
    model.state = chain_state(rig);
    model.range = unit_range(model.state);
    const AttributeFrames frames = first_edges(rest);
    PredictorBuilder builder(model.state.input_count);
    const std::size_t nodes = rig.nodes.size();
    for (std::size_t n = 0; n < nodes; ++n) {
        std::vector<std::uint32_t> vertices;
        for (std::uint32_t v = 0; v < rest.vertex_count(); ++v)
            if ((n + nodes - v * nodes / rest.vertex_count()) % nodes < density.controls) vertices.push_back(v);
        const std::vector<Monomial> monomials =
            cubic_monomials(static_cast<std::uint32_t>(3 * n), static_cast<std::uint32_t>(model.state.input_count));
        const std::uint32_t first = builder.add_monomials(monomials);
        for (std::size_t a = 0; a < attribute_count(frames.set); ++a)
            builder.add_basis(a, vertices, random_matrix(vertices.size(), density.components, 0.03f, random), first,
                              random_matrix(density.components, monomials.size(), 0.1f, random));
    }
    model.regression = builder.regression();
    const Eigen::MatrixXf means = random_matrix(attribute_count(frames.set), rest.vertex_count(), 0.3f, random);
    model.tiles = make_tiles(frames, rest.vertices, means, builder.bases(), {});
    return model;
}

// A surface, its rig, a model and a pose.
struct LearnedScene {
    LearnedScene(std::uint32_t vertices, const Density& density)
        : rest(wavy_torus(vertices)),
          rig(chain_rig(rest.vertex_count(), random)),
          model(chain_model(rest, rig, density, random)),
          posed(rest_pose(rig)),
          normals(vertex_normals(rest)) {
        for (NodeTransform& node : posed.nodes) node.rotation = Eigen::AngleAxisf(0.02f, Vec3::UnitZ());
    }
    // Each once: tiles as the host has them, components, vertices, normals, and what comes out. A multiplication and a
    // sum per entry and vertex, and about 150 operations to turn and decode a vertex.
    Work reprojection() const {
        const auto count = static_cast<double>(rest.vertex_count());
        return {.bytes = static_cast<double>(model.tiles.bytes()) +
                         4 * static_cast<double>(model.regression.components.size()) + count * (32 + 48),
                .operations = 2 * static_cast<double>(model.tiles.basis.size()) + 150 * count};
    }
    Work whole() const {
        const auto coefficients = static_cast<double>(model.regression.coefficients.size());
        return {.bytes = reprojection().bytes + 4 * coefficients +
                         12 * static_cast<double>(model.regression.monomials.size()),
                .operations = reprojection().operations + 2 * coefficients};
    }
    void count_entries(benchmark::State& state) const {
        state.counters["components"] = static_cast<double>(model.regression.components.size());
        state.counters["entries"] =
            static_cast<double>(model.tiles.basis.size()) / static_cast<double>(model.tiles.mean.size());
    }
    Random random{4};
    TriangleMesh rest;
    Rig rig;
    CurvatureModel model;
    Pose posed;
    std::vector<Vec3> normals;
};

void time_learned_curvature(benchmark::State& state, const Density& density) {
    const LearnedScene scene(static_cast<std::uint32_t>(state.range(0)), density);
    CurvatureEvaluator reference(scene.model);
    const double reference_ms =
        reference_cpu([&] { reference.evaluate(scene.rig, scene.posed, scene.rest.vertices, scene.normals); });
    const Buffer vertices = uploaded(scene.rest.vertices), normals = uploaded(scene.normals);
    Profiler profiler;
    Stream stream(bench().device, &profiler);
    GpuLearnedCurvature curvature(bench().device, scene.model);
    const auto call = [&] {
        curvature.record(stream, scene.rig, scene.posed, vertices, normals);
        stream.finish();
    };
    call();
    if (!verified(state, curvature, reference.evaluate(scene.rig, scene.posed, scene.rest.vertices, scene.normals)))
        return;
    time_call(state, profiler, scene.whole(), call);
    state.counters["reference_cpu"] = reference_ms;
    scene.count_entries(state);
    for (const auto& [kernel, entry] : profiler.entries()) state.counters[kernel] = entry.milliseconds;
}

void time_reprojection(benchmark::State& state, const Density& density) {
    const LearnedScene scene(static_cast<std::uint32_t>(state.range(0)), density);
    const BasisTiles& tiles = scene.model.tiles;
    const Eigen::MatrixXf z =
        Eigen::MatrixXf::Constant(static_cast<Eigen::Index>(scene.model.regression.components.size()), 1, 0.5f);
    const std::span<const float> components(z.data(), static_cast<std::size_t>(z.size()));
    VertexCurvature expected;
    const double reference_ms = reference_cpu([&] {
        reproject_curvature(tiles, components, {scene.rest.vertices, scene.normals}, expected);
    });
    Device& device = bench().device;
    const Buffer on_device = Buffer::of(device, components), vertices = uploaded(scene.rest.vertices),
                 normals = uploaded(scene.normals), no_rotations(device, 3 * sizeof(shared::vec4));
    Profiler profiler;
    Stream stream(device, &profiler);
    GpuReprojection reprojection(device, tiles, components.size(), 0, {});
    const auto call = [&] {
        reprojection.record(stream, on_device, {.vertices = vertices, .normals = normals, .rotations = no_rotations});
        stream.finish();
    };
    call();
    if (!verified(state, reprojection, expected)) return;
    time_call(state, profiler, scene.reprojection(), call);
    state.counters["reference_cpu"] = reference_ms;
    scene.count_entries(state);
}

// Two controls at a vertex, three components of each for each attribute.
constexpr Density k_typical{.controls = 2, .components = 3}, k_dense{.controls = 5, .components = 4};

void learned_curvature(benchmark::State& state) {
    time_learned_curvature(state, k_typical);
}
BENCHMARK(learned_curvature)->Arg(5'000)->Arg(20'000)->Arg(100'000)->UseManualTime()->Unit(benchmark::kMillisecond);

void reproject(benchmark::State& state) {
    time_reprojection(state, k_typical);
}
BENCHMARK(reproject)->Arg(5'000)->Arg(20'000)->Arg(100'000)->UseManualTime()->Unit(benchmark::kMillisecond);

void dense_learned_curvature(benchmark::State& state) {
    time_learned_curvature(state, k_dense);
}
BENCHMARK(dense_learned_curvature)
    ->Arg(5'000)
    ->Arg(20'000)
    ->Arg(100'000)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void dense_reproject(benchmark::State& state) {
    time_reprojection(state, k_dense);
}
BENCHMARK(dense_reproject)->Arg(5'000)->Arg(20'000)->Arg(100'000)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace exemplar
