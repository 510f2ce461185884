// The kernels of learned curvature (see kernel_bench.h), on models of random bases as large as trained ones.

#include <algorithm>
#include <string>

#include "apps/bench/surface_bench.h"
#include "embedded/runtime_copy_comp.h"
#include "gpu/curvature/learned_curvature.h"
#include "host/curvature/model_builder.h"
#include "host/curvature/patches.h"
#include "host/curvature/tiling.h"
#include "shaders/shared/ceilings.h"

namespace exemplar {
namespace {

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

constexpr std::size_t k_inputs = 12;  // of a patch

// Patches of which 13 vertices are read, in a random map to the inputs.
StateReader local_state(const std::vector<std::uint32_t>& patch_of_vertex, std::size_t patches, Random& random) {
    constexpr std::size_t k_read = 13;
    std::vector<std::vector<std::uint32_t>> members(patches);
    for (std::uint32_t v = 0; v < patch_of_vertex.size(); ++v)
        if (auto& patch = members[patch_of_vertex[v]]; patch.size() < k_read) patch.push_back(v);
    StateReader state;
    state.local_begin.push_back(0);
    for (std::size_t p = 0; p < patches; ++p) {
        state.local_vertex.insert(state.local_vertex.end(), members[p].begin(), members[p].end());
        state.local_begin.push_back(static_cast<std::uint32_t>(state.local_vertex.size()));
        state.controls.push_back({"patch " + std::to_string(p), static_cast<std::uint32_t>(k_inputs * p),
                                  static_cast<std::uint32_t>(k_inputs)});
        state.local_mean.emplace_back(Eigen::VectorXf::Zero(static_cast<Eigen::Index>(state.local_size(p))));
        state.unmixing.push_back(random_matrix(k_inputs, state.local_size(p), 0.05f, random));
    }
    state.input_count = k_inputs * patches;
    return state;
}

// A model of random bases that are read from local shape: each input matters to all vertices of its patch.
CurvatureModel local_model(const TriangleMesh& rest, Random& random) {
    CurvatureModel model;
    model.kind = AnimationKind::sequence;
    model.vertex_count = rest.vertex_count();
    model.segments = segment_patches(rest, surface_patches(rest, 32));
    model.state = local_state(model.segments.segment_of_vertex, model.segments.count(), random);
    model.range.mean = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(model.state.input_count));
    model.range.largest.assign(model.state.controls.size(), 1.0f);
    AttributeFrames frames = first_edges(rest);
    frames.segment = model.segments.segment_of_vertex;
    std::vector<std::vector<std::uint32_t>> members(model.segments.count());
    for (std::uint32_t v = 0; v < rest.vertex_count(); ++v) members[frames.segment[v]].push_back(v);
    PredictorBuilder builder(model.state.input_count);
    const auto one = static_cast<std::uint32_t>(model.state.input_count);
    for (std::size_t p = 0; p < members.size(); ++p) {
        const Control& control = model.state.controls[p];
        std::vector<Monomial> inputs;
        for (std::uint32_t i = 0; i < control.input_count; ++i) inputs.push_back({control.first_input + i, one, one});
        const std::uint32_t first = builder.add_inputs(inputs);
        for (std::size_t a = 0; a < attribute_count(frames.set); ++a)
            builder.add_shared_basis(a, members[p],
                                     random_matrix(members[p].size(), control.input_count, 0.03f, random), first);
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

// Device milliseconds of a kernel that does nothing but copy: half of `bytes` are read, half written. The median of
// some.
double copying_ms(double bytes) {
    constexpr std::size_t k_runs = 21;
    const auto vectors = static_cast<std::uint32_t>(bytes / (2 * sizeof(shared::vec4)));
    Device& device = bench().device;
    const Kernel kernel(device, shaders::runtime_copy_comp, {.push_constants = layout_of<shared::CopyParameters>()});
    const Buffer source(device, vectors * sizeof(shared::vec4)), target(device, source.bytes());
    Profiler profiler;
    Stream stream(device, &profiler);
    stream.fill(source, 0);
    std::vector<double> runs;
    for (std::size_t run = 0; run <= k_runs; ++run) {
        stream.dispatch(kernel, vectors, {source, target}, shared::CopyParameters{vectors});
        stream.finish();
        if (run > 0) runs.push_back(profiler.milliseconds(std::string(kernel.name())));
        profiler.reset();
    }
    std::nth_element(runs.begin(), runs.begin() + k_runs / 2, runs.end());
    return runs[k_runs / 2];
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
    state.counters["copying"] = copying_ms(scene.reprojection().bytes);
    time_call(state, profiler, scene.reprojection(), call);
    state.counters["reference_cpu"] = reference_ms;
    scene.count_entries(state);
}

// Positions and normals that are on the device, to curvature.
void local_learned_curvature(benchmark::State& state) {
    Random random{4};
    const TriangleMesh rest = wavy_torus(static_cast<std::uint32_t>(state.range(0)));
    const CurvatureModel model = local_model(rest, random);
    const std::vector<Vec3> host_normals = vertex_normals(rest);
    CurvatureEvaluator reference(model);
    const double reference_ms = reference_cpu([&] { reference.evaluate(rest.vertices, host_normals); });
    const Buffer vertices = uploaded(rest.vertices), normals = uploaded(host_normals);
    Profiler profiler;
    Stream stream(bench().device, &profiler);
    GpuLearnedCurvature curvature(bench().device, model);
    const auto call = [&] {
        curvature.record(stream, vertices, normals);
        stream.finish();
    };
    call();
    if (!verified(state, curvature, reference.evaluate(rest.vertices, host_normals))) return;
    const auto count = static_cast<double>(rest.vertex_count()),
               numbers = static_cast<double>(StateReader::k_local_numbers * model.state.local_vertex.size());
    // Each once: tiles, the map in halves, vertices, normals, and what comes out.
    time_call(state, profiler,
              {.bytes = static_cast<double>(model.tiles.bytes()) + 2 * k_inputs * numbers + count * (32 + 48),
               .operations = 2 * static_cast<double>(model.tiles.basis.size()) + 2 * k_inputs * numbers + 150 * count},
              call);
    state.counters["reference_cpu"] = reference_ms;
    for (const auto& [kernel, entry] : profiler.entries()) state.counters[kernel] = entry.milliseconds;
}
BENCHMARK(local_learned_curvature)->Apply(three_sizes);

// Two controls at a vertex, three components of each for each attribute.
constexpr Density k_typical{.controls = 2, .components = 3}, k_dense{.controls = 5, .components = 4};

void learned_curvature(benchmark::State& state) {
    time_learned_curvature(state, k_typical);
}
BENCHMARK(learned_curvature)->Apply(three_sizes);

void reproject(benchmark::State& state) {
    time_reprojection(state, k_typical);
}
BENCHMARK(reproject)->Apply(three_sizes);

void dense_learned_curvature(benchmark::State& state) {
    time_learned_curvature(state, k_dense);
}
BENCHMARK(dense_learned_curvature)->Apply(three_sizes);

void dense_reproject(benchmark::State& state) {
    time_reprojection(state, k_dense);
}
BENCHMARK(dense_reproject)->Apply(three_sizes);

}  // namespace
}  // namespace exemplar
