// Learned curvature, on models of random bases as large as trained ones.

#include <algorithm>
#include <string>

#include "apps/bench/kernels/surfaces.h"
#include "embedded/curvature_components_comp.h"
#include "embedded/curvature_features_comp.h"
#include "embedded/curvature_local_state_comp.h"
#include "embedded/curvature_patch_rotations_comp.h"
#include "embedded/curvature_reproject_comp.h"
#include "gpu/curvature/learned/learned_curvature.h"
#include "host/curvature/learning/model_builder.h"
#include "host/curvature/model/tiling.h"
#include "host/curvature/state/patches.h"

namespace exemplar {
namespace {

// Number of components that affect a vertex.
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
    auto& joints = state.source.emplace<JointState>();
    for (std::uint32_t n = 0; n < rig.nodes.size(); ++n) {
        joints.nodes.push_back(n);
        joints.reference.push_back(Eigen::Quaternionf::Identity());
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

// Makes frames along the first edge of some face of each vertex.
AttributeFrames first_edges(const TriangleMesh& mesh) {
    AttributeFrames frames;
    frames.neighbor.resize(mesh.vertex_count());
    for (const Face& face : mesh.faces)
        for (std::size_t i = 0; i < 3; ++i) frames.neighbor[face[i]] = face[(i + 1) % 3];
    return frames;
}

// Makes a pose range of mean 0, unit whitening and largest distance 1.
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
    auto& local = state.source.emplace<LocalShapeState>();
    local.begin.push_back(0);
    for (std::size_t p = 0; p < patches; ++p) {
        local.vertex.insert(local.vertex.end(), members[p].begin(), members[p].end());
        local.begin.push_back(static_cast<std::uint32_t>(local.vertex.size()));
        state.controls.push_back({"patch " + std::to_string(p), static_cast<std::uint32_t>(k_inputs * p),
                                  static_cast<std::uint32_t>(k_inputs)});
        local.mean.emplace_back(Eigen::VectorXf::Zero(static_cast<Eigen::Index>(local.size(p))));
        local.map.push_back(random_matrix(k_inputs, local.size(p), 0.05f, random));
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

// Two controls at a vertex, three components of each for each attribute.
constexpr Density k_typical{.controls = 2, .components = 3};

// Reads tiles, components, vertices and normals and writes the result once each. A multiplication and a sum per
// entry and vertex, and about 150 operations to rotate and decode a vertex.
Work reprojection_work(const CurvatureModel& model) {
    const auto count = static_cast<double>(model.vertex_count);
    return {.bytes = static_cast<double>(model.tiles.bytes()) +
                     4 * static_cast<double>(model.regression.components.size()) + count * (32 + 48),
            .operations = 2 * static_cast<double>(model.tiles.basis.size()) + 150 * count};
}

struct Additive {
    Additive(Device& device, Profiler& profiler, std::size_t vertices)
        : rest(wavy_torus(static_cast<std::uint32_t>(vertices))),
          rig(chain_rig(rest.vertex_count(), random)),
          model(chain_model(rest, rig, k_typical, random)),
          posed(rest_pose(rig)),
          normals(vertex_normals(rest)),
          device_vertices(uploaded(device, rest.vertices)),
          device_normals(uploaded(device, normals)),
          stream(device, &profiler),
          curvature(device, model) {
        for (NodeTransform& node : posed.nodes) node.rotation = Eigen::AngleAxisf(0.02f, Vec3::UnitZ());
    }
    void run() {
        curvature.record(stream, {.vertices = device_vertices, .normals = device_normals, .rig = &rig, .pose = &posed});
        stream.finish();
    }
    std::vector<Difference> differences() const {
        CurvatureEvaluator reference(model);
        return differences_of(curvature, reference.evaluate(rig, posed, rest.vertices, normals));
    }
    std::map<std::string, Work> work() const {
        const auto monomials = static_cast<double>(model.regression.monomials.size()),
                   components = static_cast<double>(model.regression.components.size()),
                   coefficients = static_cast<double>(model.regression.coefficients.size());
        return {{"curvature/features.comp", {.bytes = monomials * (16 + 4), .operations = 2 * monomials}},
                {"curvature/components.comp",
                 {.bytes = 4 * coefficients + (16 + 4) * components + 4 * monomials, .operations = 2 * coefficients}},
                {"curvature/reproject.comp", reprojection_work(model)}};
    }
    Random random{4};
    TriangleMesh rest;
    Rig rig;
    CurvatureModel model;
    Pose posed;
    std::vector<Vec3> normals;
    Buffer device_vertices, device_normals;
    Stream stream;
    GpuLearnedCurvature curvature;
};

// Curvature from positions and normals that are on the device.
struct Local {
    Local(Device& device, Profiler& profiler, std::size_t vertices)
        : rest(wavy_torus(static_cast<std::uint32_t>(vertices))),
          model(local_model(rest, random)),
          normals(vertex_normals(rest)),
          device_vertices(uploaded(device, rest.vertices)),
          device_normals(uploaded(device, normals)),
          stream(device, &profiler),
          curvature(device, model) {}
    void run() {
        curvature.record(stream, {.vertices = device_vertices, .normals = device_normals});
        stream.finish();
    }
    std::vector<Difference> differences() const {
        CurvatureEvaluator reference(model);
        return differences_of(curvature, reference.evaluate(rest.vertices, normals));
    }
    // A patch reads 24 vertices for its rotation; an input reads a map in halves, and vertices and normals of its
    // patch.
    std::map<std::string, Work> work() const {
        const auto patches = static_cast<double>(model.segments.count()),
                   inputs = static_cast<double>(model.state.input_count),
                   members = static_cast<double>(std::get<LocalShapeState>(model.state.source).vertex.size()),
                   numbers = static_cast<double>(LocalShapeState::k_numbers) * members;
        return {{"curvature/patch_rotations.comp",
                 {.bytes = patches * (96 + 24 * 16 + 48), .operations = patches * (24 * 3 + 60)}},
                {"curvature/local_state.comp",
                 {.bytes = 2 * k_inputs * numbers + members * 36 + inputs * (16 + 4 + 4),
                  .operations = 2 * k_inputs * numbers}},
                {"curvature/reproject.comp", reprojection_work(model)}};
    }
    Random random{4};
    TriangleMesh rest;
    CurvatureModel model;
    std::vector<Vec3> normals;
    Buffer device_vertices, device_normals;
    Stream stream;
    GpuLearnedCurvature curvature;
};

}  // namespace

std::vector<OperationKind> learned_curvature_operations() {
    const std::vector<std::size_t> sizes{5'000, 20'000, 100'000};
    return {
        {"learned curvature, additive",
         "vertices",
         sizes,
         {&shaders::curvature_features_comp, &shaders::curvature_components_comp, &shaders::curvature_reproject_comp},
         {k_reprojected_quads},
         prepare_as<Additive>},
        {"learned curvature, local",
         "vertices",
         sizes,
         {&shaders::curvature_patch_rotations_comp, &shaders::curvature_local_state_comp,
          &shaders::curvature_reproject_comp},
         {k_reprojected_quads},
         prepare_as<Local>}};
}

}  // namespace exemplar
