// What a model of learned curvature promises: whatever its file held, it can be used.
#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/curvature/model/model.h"
#include "tests/fuzz/support/promises.h"

namespace exemplar::fuzz {
namespace {

constexpr std::uint32_t k_few = 4;  // joints and targets of the rig that models are used on

/// A surface without faces at some moment.
struct MadeUpSurface {
    std::vector<Vec3> vertices, normals;
};

Vec3 random_vector(Random& random) {
    return {float(random.uniform(-1, 1)), float(random.uniform(-1, 1)), float(random.uniform(-1, 1))};
}

MadeUpSurface scattered(std::size_t vertex_count) {
    Random random(1);
    MadeUpSurface surface;
    for (std::size_t v = 0; v < vertex_count; ++v) {
        surface.vertices.push_back(3 * random_vector(random));
        surface.normals.push_back(random_vector(random).normalized());
    }
    return surface;
}

/// All in one place, where edges and hinges have no direction.
MadeUpSurface collapsed(std::size_t vertex_count) {
    return {std::vector<Vec3>(vertex_count, Vec3::Zero()), std::vector<Vec3>(vertex_count, -Vec3::UnitZ())};
}

/// What the model was learned on, unless it names joints or targets beyond the first few.
Animation animation_of(const CurvatureModel& model, const MadeUpSurface& surface) {
    Animation animation;
    animation.name = "x.glb";
    animation.kind = model.kind;
    animation.rest.vertices = surface.vertices;
    if (model.kind == AnimationKind::sequence) return animation;
    Rig& rig = animation.rig;
    for (std::uint32_t i = 0; i < k_few; ++i) {
        rig.nodes.push_back({"joint", i == 0 ? k_invalid_index : i - 1, {}});
        rig.bones.push_back({i, Affine::Identity()});
        rig.targets.push_back({"target", {}, {}, 0});
    }
    const std::span<const std::uint32_t> parts = model.state.parts_of_rig();
    for (std::size_t c = 0; c < parts.size(); ++c)
        if (const std::uint32_t i = parts[c]; i < k_few)
            rig.nodes[i].name = rig.targets[i].name = model.state.controls[c].name;
    return animation;
}

Pose some_pose(const Rig& rig) {
    Pose pose = rest_pose(rig);
    Random random(2);
    for (NodeTransform& node : pose.nodes)
        node.rotation = Eigen::AngleAxisf(float(random.uniform(0, 3)), random_vector(random).normalized());
    for (float& weight : pose.weights) weight = float(random.uniform());
    return pose;
}

void require_curvature(const VertexCurvature& curvature, std::size_t vertex_count) {
    require(curvature.k1.size() == vertex_count && curvature.e2.size() == vertex_count &&
                curvature.derivative.size() == vertex_count,
            "curvature of each vertex");
}

void require_use(const CurvatureModel& model, const MadeUpSurface& surface) {
    CurvatureEvaluator evaluator(model);
    if (model.kind == AnimationKind::sequence)
        return require_curvature(evaluator.evaluate(surface.vertices, surface.normals), model.vertex_count);
    const Animation animation = animation_of(model, surface);
    const std::string refusal = "the model does not fit " + animation.name;
    if (!accepts<ModelError>(refusal, 0, {1 << 16, 0}, [&] { require_compatible(model, animation); })) return;
    const Pose pose = some_pose(animation.rig);
    require_curvature(evaluator.evaluate(animation.rig, pose, surface.vertices, surface.normals), model.vertex_count);
}

/// From inputs to curvature, which needs no joints.
void require_prediction(const CurvatureModel& model, const MadeUpSurface& surface) {
    Random random(3);
    std::vector<float> x(model.state.input_count), features(model.regression.feature_count()),
        z(model.regression.components.size());
    for (float& value : x) value = float(random.uniform(-9, 9));
    const PoseRange::Farthest farthest = model.range.prepare(model.state, x);
    require(farthest.control < std::max<std::size_t>(model.state.controls.size(), 1), "a control is farthest");
    model.regression.evaluate(x, features, z);
    const std::vector<Eigen::Matrix3f> rotations(model.segments.count(), Eigen::Matrix3f::Identity());
    VertexCurvature curvature;
    reproject_curvature(model.tiles, z, {surface.vertices, surface.normals, rotations}, curvature);
    require_curvature(curvature, model.vertex_count);
}

}  // namespace

void require_promises(const CurvatureModel& model) {
    CurvatureModel fitting = model;
    fitting.topology = topology_hash({}, model.vertex_count);
    for (const MadeUpSurface& surface : {scattered(model.vertex_count), collapsed(model.vertex_count)}) {
        require_prediction(fitting, surface);
        require_use(fitting, surface);
    }
}

}  // namespace exemplar::fuzz
