#include "host/curvature/state/state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/core/parallel.h"
#include "host/curvature/state/patches.h"
#include "host/learn/components/fast_ica.h"
#include "host/learn/decompositions.h"
#include "host/mesh/topology.h"

namespace exemplar {

namespace {

using Eigen::Quaternionf;

/// A joint that turns less than this (radians, about a degree) is no control: it hardly moves the surface.
constexpr float k_min_turn = 0.02f;
constexpr float k_min_joint_weight = 1e-3f;

/// Returns the mean rotation of a node: the principal axis of its quaternions as points in four dimensions.
Quaternionf mean_rotation(std::span<const Pose* const> poses, std::size_t node) {
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    for (const Pose* pose : poses) {
        const Eigen::Vector4d q = pose->nodes[node].rotation.coeffs().cast<double>();
        sum += q * q.transpose();
    }
    Quaternionf mean;
    mean.coeffs() = symmetric_eigen(sum).vectors.col(3).cast<float>();
    return mean.normalized();
}

Vec3 vector_part(const Quaternionf& reference, const Quaternionf& rotation) {
    const Quaternionf relative = reference.conjugate() * rotation;
    return relative.w() < 0 ? Vec3(-relative.vec()) : Vec3(relative.vec());
}

void add_control(StateReader& reader, const std::string& name, std::uint32_t inputs) {
    reader.controls.push_back({name, static_cast<std::uint32_t>(reader.input_count), inputs});
    reader.input_count += inputs;
}

/// Returns which nodes can bend the surface by their rotation: the nodes of bones and their ancestors.
std::vector<bool> nodes_above_bones(const Rig& rig) {
    std::vector<bool> used(rig.nodes.size(), false);
    for (const Bone& bone : rig.bones)
        for (std::uint32_t node = bone.node; node != k_invalid_index && !used[node]; node = rig.nodes[node].parent)
            used[node] = true;
    return used;
}

void add_joints(const Rig& rig, std::span<const Pose* const> poses, StateReader& reader) {
    const std::vector<bool> used = nodes_above_bones(rig);
    JointState joints;
    for (std::uint32_t node = 0; node < rig.nodes.size(); ++node) {
        if (!used[node]) continue;
        const Quaternionf reference = mean_rotation(poses, node);
        const bool turns = std::any_of(poses.begin(), poses.end(), [&](const Pose* pose) {
            return 2 * vector_part(reference, pose->nodes[node].rotation).norm() > k_min_turn;
        });
        if (!turns) continue;
        add_control(reader, rig.nodes[node].name, 3);
        joints.nodes.push_back(node);
        joints.reference.push_back(reference);
    }
    reader.source = std::move(joints);
}

void add_targets(const Rig& rig, std::span<const Pose* const> poses, StateReader& reader) {
    WeightState weights;
    for (std::uint32_t target = 0; target < rig.targets.size(); ++target) {
        const float first = poses.front()->weights[target];
        const bool changes = std::any_of(poses.begin(), poses.end(), [&](const Pose* pose) {
            return std::abs(pose->weights[target] - first) > k_min_joint_weight;
        });
        if (!changes) continue;
        add_control(reader, rig.targets[target].name, 1);
        weights.targets.push_back(target);
    }
    reader.source = std::move(weights);
}

std::vector<Hinge> all_hinges(const TriangleMesh& mesh) {
    const Topology topology = build_topology(mesh);
    std::vector<Hinge> hinges;
    for (const Edge& edge : topology.edges) {
        if (edge.is_boundary()) continue;
        Hinge hinge{edge.vertex[0], edge.vertex[1], k_invalid_index, k_invalid_index};
        for (std::size_t side = 0; side < 2; ++side) {
            const Face& face = mesh.faces[edge.face[side]];
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t from = face[i], to = face[(i + 1) % 3], third = face[(i + 2) % 3];
                if (from == hinge.a && to == hinge.b) hinge.left = third;
                if (from == hinge.b && to == hinge.a) hinge.right = third;
            }
        }
        if (hinge.left != k_invalid_index && hinge.right != k_invalid_index) hinges.push_back(hinge);
    }
    return hinges;
}

/// Returns for each patch the hinges that have a vertex in it, at most `most`, evenly spaced.
std::vector<std::vector<Hinge>> hinges_of_patches(const std::vector<Hinge>& all,
                                                  const std::vector<std::uint32_t>& patch_of_vertex, std::size_t most) {
    const std::uint32_t count = 1 + *std::max_element(patch_of_vertex.begin(), patch_of_vertex.end());
    std::vector<std::vector<Hinge>> patches(count);
    for (const Hinge& hinge : all) {
        std::array<std::uint32_t, 4> near{patch_of_vertex[hinge.a], patch_of_vertex[hinge.b],
                                          patch_of_vertex[hinge.left], patch_of_vertex[hinge.right]};
        std::sort(near.begin(), near.end());
        const auto end = std::unique(near.begin(), near.end());
        for (auto patch = near.begin(); patch != end; ++patch) patches[*patch].push_back(hinge);
    }
    for (auto& hinges : patches) {
        if (hinges.size() <= most) continue;
        std::vector<Hinge> taken;
        for (std::size_t h = 0; h < most; ++h) taken.push_back(hinges[h * hinges.size() / most]);
        hinges = std::move(taken);
    }
    return patches;
}

/// frames x hinges
Eigen::MatrixXf angles_of(const std::vector<Hinge>& hinges, std::span<const std::vector<Vec3>> frames) {
    Eigen::MatrixXf angles(static_cast<Eigen::Index>(frames.size()), static_cast<Eigen::Index>(hinges.size()));
    for (std::size_t i = 0; i < frames.size(); ++i)
        for (std::size_t h = 0; h < hinges.size(); ++h)
            angles(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(h)) = bend(hinges[h], frames[i]);
    return angles;
}

/// Makes the inputs of a control uncorrelated and of unit variance. centered: poses x inputs.
Eigen::MatrixXf whitening_of(const Eigen::MatrixXd& centered) {
    const Eigen::MatrixXd covariance = centered.transpose() * centered / static_cast<double>(centered.rows());
    const SymmetricEigen eigen = symmetric_eigen(covariance);
    // A direction that hardly varied in training gets a minimum variance: a hundredth of the largest.
    const double floor = std::max(1e-2 * eigen.values.maxCoeff(), 1e-8);
    const Eigen::VectorXd scale = eigen.values.cwiseMax(floor).cwiseSqrt().cwiseInverse();
    return (scale.asDiagonal() * eigen.vectors.transpose()).cast<float>();
}

}  // namespace

float bend(const Hinge& hinge, std::span<const Vec3> vertices) {
    const Vec3 &a = vertices[hinge.a], &b = vertices[hinge.b];
    const Vec3 edge = b - a, left = edge.cross(vertices[hinge.left] - a),
               right = (vertices[hinge.right] - a).cross(edge);
    const float sine = left.cross(right).dot(edge), cosine = left.dot(right) * edge.norm();
    return std::atan2(sine, cosine);
}

void LocalShapeState::read(std::size_t control, std::span<const Vec3> vertices, std::span<const Vec3> normals,
                           const Eigen::Matrix3f& rotation, std::span<float> shape) const {
    const std::span<const std::uint32_t> members(vertex.data() + begin[control], begin[control + 1] - begin[control]);
    Vec3 center = Vec3::Zero();
    for (const std::uint32_t v : members) center += vertices[v];
    center /= static_cast<float>(std::max<std::size_t>(members.size(), 1));
    const Vec3 up = rotation.col(2) / unit;
    float* out = shape.data();
    for (const std::uint32_t v : members) {
        Eigen::Map<Vec3>(out).noalias() = rotation.transpose() * normals[v];
        out[3] = up.dot(vertices[v] - center);
        out += k_numbers;
    }
}

std::span<const std::uint32_t> StateReader::parts_of_rig() const {
    if (const auto* joints = std::get_if<JointState>(&source)) return joints->nodes;
    if (const auto* weights = std::get_if<WeightState>(&source)) return weights->targets;
    return {};
}

void StateReader::read_pose(const Pose& pose, std::span<float> x) const {
    if (const auto* weights = std::get_if<WeightState>(&source)) {
        for (std::size_t c = 0; c < controls.size(); ++c)
            x[controls[c].first_input] = pose.weights[weights->targets[c]];
        return;
    }
    const auto& joints = std::get<JointState>(source);
    for (std::size_t c = 0; c < controls.size(); ++c) {
        const Vec3 part = vector_part(joints.reference[c], pose.nodes[joints.nodes[c]].rotation);
        for (int i = 0; i < 3; ++i) x[controls[c].first_input + i] = part[i];
    }
}

void StateReader::read_surface(std::span<const Vec3> vertices, std::span<const Vec3> normals,
                               std::span<const Eigen::Matrix3f> rotations, std::span<float> x) const {
    const auto inputs = [&](std::size_t c) {
        return Eigen::Map<Eigen::VectorXf>(x.data() + controls[c].first_input, controls[c].input_count);
    };
    Eigen::VectorXf room;
    if (const auto* local = std::get_if<LocalShapeState>(&source)) {
        std::size_t largest = 0;
        for (std::size_t c = 0; c < controls.size(); ++c) largest = std::max(largest, local->size(c));
        room.resize(static_cast<Eigen::Index>(largest));
        for (std::size_t c = 0; c < controls.size(); ++c) {
            auto shape = room.head(static_cast<Eigen::Index>(local->size(c)));
            local->read(c, vertices, normals, rotations[c], {shape.data(), local->size(c)});
            shape -= local->mean[c];
            inputs(c).noalias() = local->map[c] * shape;
        }
        return;
    }
    const auto& hinges = std::get<HingeState>(source);
    for (std::size_t c = 0; c < controls.size(); ++c) {
        const std::uint32_t first = hinges.begin[c], count = hinges.begin[c + 1] - first;
        room.resize(count);
        for (std::uint32_t h = 0; h < count; ++h) room[h] = bend(hinges.hinges[first + h], vertices);
        inputs(c).noalias() = hinges.unmixing[c] * (room - hinges.mean.segment(first, count));
    }
}

StateReader make_rig_state(const Animation& animation, std::span<const Pose* const> poses) {
    StateReader reader;
    if (animation.kind == AnimationKind::blend_shapes)
        add_targets(animation.rig, poses, reader);
    else
        add_joints(animation.rig, poses, reader);
    return reader;
}

StateReader make_sequence_state(const TriangleMesh& rest, std::span<const std::vector<Vec3>> frames,
                                const SequenceStateOptions& options) {
    StateReader reader;
    reader.control_of_vertex = surface_patches(rest, options.patch_vertices);
    const std::vector<std::vector<Hinge>> patches =
        hinges_of_patches(all_hinges(rest), reader.control_of_vertex, options.max_hinges);
    const bool is_whole = patches.size() == 1;
    std::vector<Ica> components(patches.size());
    parallel_for(patches.size(), [&](std::size_t patch) {
        if (patches[patch].empty()) return;
        components[patch] = fit_ica(
            angles_of(patches[patch], frames),
            {.share = options.share, .most = is_whole ? k_unlimited : options.max_inputs, .seed = options.seed});
    });
    HingeState state;
    state.begin.push_back(0);
    for (std::size_t patch = 0; patch < patches.size(); ++patch) {
        state.hinges.insert(state.hinges.end(), patches[patch].begin(), patches[patch].end());
        state.begin.push_back(static_cast<std::uint32_t>(state.hinges.size()));
        state.mean.conservativeResize(static_cast<Eigen::Index>(state.hinges.size()));
        state.mean.tail(static_cast<Eigen::Index>(patches[patch].size())) = components[patch].mean;
        state.unmixing.push_back(components[patch].unmixing);
        add_control(reader, is_whole ? "surface" : "patch " + std::to_string(patch),
                    static_cast<std::uint32_t>(components[patch].unmixing.rows()));
    }
    reader.source = std::move(state);
    return reader;
}

PoseRange make_pose_range(const StateReader& reader, const Eigen::Ref<const Eigen::MatrixXf>& states,
                          std::size_t real) {
    PoseRange range;
    const std::size_t averaged = std::min(real, static_cast<std::size_t>(states.rows()));
    range.mean = states.topRows(static_cast<Eigen::Index>(averaged)).colwise().mean();
    const Eigen::MatrixXf centered = states.rowwise() - range.mean.transpose();
    for (const Control& control : reader.controls) {
        if (control.input_count == 0) {  // a patch that does not bend
            if (!reader.is_local()) range.whitening.emplace_back(0, 0);
            range.largest.push_back(1);
            continue;
        }
        Eigen::MatrixXf white = centered.middleCols(control.first_input, control.input_count);
        if (!reader.is_local()) {
            range.whitening.push_back(whitening_of(white.cast<double>()));
            white *= range.whitening.back().transpose();
        }
        range.largest.push_back(std::max(white.rowwise().norm().maxCoeff(), 1e-6f));
    }
    return range;
}

float PoseRange::distance(const Control& control, std::size_t index, std::span<const float> x) const {
    const Eigen::Map<const Eigen::VectorXf> here(x.data() + control.first_input, control.input_count);
    const auto middle = mean.segment(control.first_input, control.input_count);
    if (whitening.empty()) return (here - middle).norm() / largest[index];
    // Most controls are small: fixed maximum sizes avoid allocations.
    constexpr int k_small = 32;
    if (control.input_count > k_small) return (whitening[index] * (here - middle)).norm() / largest[index];
    using Small = Eigen::Matrix<float, Eigen::Dynamic, 1, Eigen::ColMajor, k_small, 1>;
    const Small offset = here - middle;
    const Small white = whitening[index].lazyProduct(offset);
    return white.norm() / largest[index];
}

PoseRange::Farthest PoseRange::farthest(const StateReader& reader, std::span<const float> x) const {
    Farthest result;
    for (std::size_t c = 0; c < reader.controls.size(); ++c)
        if (const float d = distance(reader.controls[c], c, x); d > result.distance) result = {c, d};
    return result;
}

PoseRange::Farthest PoseRange::bound(const StateReader& reader, std::span<float> x) const {
    Farthest result;
    for (std::size_t c = 0; c < reader.controls.size(); ++c) {
        const Control& control = reader.controls[c];
        const float d = distance(control, c, x);
        if (d > result.distance) result = {c, d};
        if (!(d > 1)) continue;
        const auto middle = mean.segment(control.first_input, control.input_count);
        Eigen::Map<Eigen::VectorXf> here(x.data() + control.first_input, control.input_count);
        here = middle + (here - middle) / d;
    }
    return result;
}

PoseRange::Farthest PoseRange::prepare(const StateReader& reader, std::span<float> x) const {
    const Farthest result = reader.is_local() ? farthest(reader, x) : bound(reader, x);
    Eigen::Map<Eigen::VectorXf>(x.data(), mean.size()) -= mean;
    return result;
}

}  // namespace exemplar
