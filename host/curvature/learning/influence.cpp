#include "host/curvature/learning/influence.h"

#include <Eigen/QR>
#include <algorithm>
#include <map>

#include "host/core/parallel.h"
#include "host/learn/regression/f_test.h"
#include "host/learn/regression/least_squares.h"
#include "host/mesh/topology.h"

namespace exemplar {

namespace {

using ControlSet = std::vector<std::uint32_t>;

/// Bones with less weight at a vertex are ignored.
constexpr float k_min_bone_weight = 0.02f;

std::vector<InfluenceGroup> grouped(const std::vector<ControlSet>& of_vertex) {
    std::map<ControlSet, std::size_t> index;
    std::vector<InfluenceGroup> groups;
    for (std::uint32_t v = 0; v < of_vertex.size(); ++v) {
        const auto [place, is_new] = index.try_emplace(of_vertex[v], groups.size());
        if (is_new) groups.push_back({of_vertex[v], {}});
        groups[place->second].vertices.push_back(v);
    }
    return groups;
}

void merge_into(ControlSet& target, const ControlSet& other) {
    ControlSet merged;
    std::set_union(target.begin(), target.end(), other.begin(), other.end(), std::back_inserter(merged));
    target = std::move(merged);
}

/// Merges into the set of each vertex those of its neighbors, `rings` times.
void spread(const std::vector<Face>& faces, int rings, std::vector<ControlSet>& sets) {
    for (int ring = 0; ring < rings; ++ring) {
        std::vector<ControlSet> wider = sets;
        for (const Face& face : faces)
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 1; j < 3; ++j) {
                    const ControlSet& other = sets[face[(i + j) % 3]];
                    if (other != wider[face[i]]) merge_into(wider[face[i]], other);
                }
        sets = std::move(wider);
    }
}

std::vector<ControlSet> bones_of_vertices(const Rig& rig, std::size_t count) {
    std::vector<ControlSet> bones(count);
    for (std::size_t v = 0; v < count; ++v)
        for (const Influence& influence : rig.influences_of(v))
            if (influence.weight >= k_min_bone_weight) bones[v].push_back(influence.bone);
    return bones;
}

/// Returns the nodes from `node` up to its root.
std::vector<std::uint32_t> path_up(const Rig& rig, std::uint32_t node) {
    std::vector<std::uint32_t> path;
    for (; node != k_invalid_index; node = rig.nodes[node].parent) path.push_back(node);
    return path;
}

/// Returns the joints between bones: the bones' nodes and their ancestors, below the lowest one common to all.
ControlSet joints_between(const Rig& rig, const ControlSet& bones, const std::vector<std::uint32_t>& control_of_node) {
    std::map<std::uint32_t, std::size_t> seen;
    for (const std::uint32_t bone : bones)
        for (const std::uint32_t node : path_up(rig, rig.bones[bone].node)) ++seen[node];
    ControlSet joints;
    for (const auto& [node, times] : seen)
        if (times < bones.size() && control_of_node[node] != k_invalid_index) joints.push_back(control_of_node[node]);
    std::sort(joints.begin(), joints.end());
    return joints;
}

std::vector<ControlSet> joints_of_vertices(const Animation& animation, const StateReader& reader, int rings) {
    const Rig& rig = animation.rig;
    std::vector<std::uint32_t> control_of_node(rig.nodes.size(), k_invalid_index);
    const std::span<const std::uint32_t> joints = reader.parts_of_rig();
    for (std::uint32_t c = 0; c < joints.size(); ++c) control_of_node[joints[c]] = c;
    std::vector<ControlSet> sets = bones_of_vertices(rig, animation.rest.vertex_count());
    spread(animation.rest.faces, rings, sets);
    std::map<ControlSet, ControlSet> known;
    for (ControlSet& set : sets) {
        const auto [place, is_new] = known.try_emplace(set);
        if (is_new) place->second = joints_between(rig, set, control_of_node);
        set = place->second;
    }
    return sets;
}

/// Gives vertices without controls those of their neighbors, ring by ring, until nothing changes.
void fill(const std::vector<Face>& faces, std::vector<ControlSet>& sets) {
    for (bool changes = true; changes;) {
        changes = false;
        std::vector<ControlSet> wider = sets;
        for (const Face& face : faces)
            for (std::size_t i = 0; i < 3; ++i) {
                if (!sets[face[i]].empty()) continue;
                for (std::size_t j = 1; j < 3; ++j) merge_into(wider[face[i]], sets[face[(i + j) % 3]]);
                changes |= !wider[face[i]].empty();
            }
        sets = std::move(wider);
    }
}

std::vector<ControlSet> targets_of_vertices(const Animation& animation, const StateReader& reader, int rings) {
    std::vector<ControlSet> sets(animation.rest.vertex_count());
    const std::span<const std::uint32_t> targets = reader.parts_of_rig();
    for (std::uint32_t c = 0; c < targets.size(); ++c)
        for (const std::uint32_t v : animation.rig.targets[targets[c]].vertices) sets[v].push_back(c);
    spread(animation.rest.faces, rings, sets);
    return sets;
}

/// Computes the quadratic features of some controls, with the constant.
Eigen::MatrixXd features_of(const StateReader& reader, const ControlSet& controls,
                            const Eigen::Ref<const Eigen::MatrixXf>& states) {
    Eigen::Index inputs = 0;
    for (const std::uint32_t c : controls) inputs += reader.controls[c].input_count;
    Eigen::MatrixXf x(states.rows(), inputs);
    Eigen::Index at = 0;
    for (const std::uint32_t c : controls) {
        const Control& control = reader.controls[c];
        x.middleCols(at, control.input_count) = states.middleCols(control.first_input, control.input_count);
        at += control.input_count;
    }
    return polynomial_features(x, 2);
}

/// A least-squares fit of many targets: residual sums of squares, and the number of parameters that are determined.
struct Fit {
    Eigen::VectorXd residual;
    std::size_t parameters;
};
Fit fit(const Eigen::MatrixXd& features, const Eigen::MatrixXd& targets) {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(features);
    qr.setThreshold(1e-5);  // a joint that does not turn about an axis leaves only rounding there
    const Eigen::Index rank = qr.rank();
    const Eigen::MatrixXd rotated = qr.householderQ().adjoint() * targets;
    return {rotated.bottomRows(rotated.rows() - rank).colwise().squaredNorm(), static_cast<std::size_t>(rank)};
}

/// Returns for each vertex of a group the controls that pass the test.
std::vector<ControlSet> test_group(const InfluenceGroup& group, const StateReader& reader,
                                   const Eigen::Ref<const Eigen::MatrixXf>& states, const Eigen::MatrixXd& targets,
                                   const InfluenceTest& options) {
    const auto samples = static_cast<std::size_t>(states.rows());
    const Fit full = fit(features_of(reader, group.controls, states), targets);
    const Eigen::VectorXd variation = (targets.rowwise() - targets.colwise().mean()).colwise().squaredNorm();
    std::vector<ControlSet> kept(group.vertices.size());
    Eigen::MatrixXd alone(targets.cols(), static_cast<Eigen::Index>(group.controls.size()));
    for (std::size_t c = 0; c < group.controls.size(); ++c) {
        ControlSet others = group.controls;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(c));
        const Fit without = fit(features_of(reader, others, states), targets);
        alone.col(static_cast<Eigen::Index>(c)) =
            fit(features_of(reader, {group.controls[c]}, states), targets).residual;
        for (std::size_t i = 0; i < kept.size(); ++i) {
            const auto column = static_cast<Eigen::Index>(i);
            // A control that adds no parameter has inputs that are combinations of the others'.
            if (without.parameters >= full.parameters) continue;
            const FTest test = f_test(without.residual[column], without.parameters, full.residual[column],
                                      full.parameters, samples, variation[column]);
            const double gain = without.residual[column] - full.residual[column];
            if (test.p_value < options.significance && gain >= options.min_gain * variation[column])
                kept[i].push_back(group.controls[c]);
        }
    }
    for (std::size_t i = 0; i < kept.size(); ++i) {
        if (!kept[i].empty()) continue;
        Eigen::Index best = 0;
        alone.row(static_cast<Eigen::Index>(i)).minCoeff(&best);
        kept[i] = {group.controls[static_cast<std::size_t>(best)]};
    }
    return kept;
}

}  // namespace

std::vector<InfluenceGroup> candidate_influences(const Animation& animation, const StateReader& reader, int rings) {
    std::vector<ControlSet> sets;
    switch (animation.kind) {
        case AnimationKind::skeleton:
            sets = joints_of_vertices(animation, reader, rings);
            break;
        case AnimationKind::blend_shapes:
            sets = targets_of_vertices(animation, reader, rings);
            break;
        case AnimationKind::sequence:
            for (const std::uint32_t control : reader.control_of_vertex) sets.push_back({control});
            break;
    }
    fill(animation.rest.faces, sets);
    return grouped(sets);
}

std::vector<InfluenceGroup> significant_influences(const std::vector<InfluenceGroup>& possible,
                                                   const StateReader& reader,
                                                   const Eigen::Ref<const Eigen::MatrixXf>& states,
                                                   const Eigen::Ref<const Eigen::MatrixXf>& mean_curvature,
                                                   const std::vector<bool>& varies, const InfluenceTest& options) {
    std::vector<ControlSet> kept(varies.size());
    parallel_for(possible.size(), [&](std::size_t g) {
        InfluenceGroup group{possible[g].controls, {}};
        for (const std::uint32_t v : possible[g].vertices)
            if (varies[v]) group.vertices.push_back(v);
        if (group.controls.empty() || group.vertices.empty()) return;
        Eigen::MatrixXd targets(states.rows(), static_cast<Eigen::Index>(group.vertices.size()));
        for (std::size_t i = 0; i < group.vertices.size(); ++i)
            targets.col(static_cast<Eigen::Index>(i)) = mean_curvature.col(group.vertices[i]).cast<double>();
        const std::vector<ControlSet> sets = test_group(group, reader, states, targets, options);
        for (std::size_t i = 0; i < sets.size(); ++i) kept[group.vertices[i]] = sets[i];
    });
    return grouped(kept);
}

}  // namespace exemplar
