#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "host/animation/animation.h"
#include "host/curvature/state/state.h"

namespace exemplar {

/// Vertices whose curvature the same controls can change.
struct InfluenceGroup {
    std::vector<std::uint32_t> controls;  ///< rising; none for vertices that stay as they are
    std::vector<std::uint32_t> vertices;  ///< rising
};

/// The controls that could matter to each vertex. Curvature does not change under rigid motion, so of a skeleton these
/// are the joints on the paths between the bones that hold the vertex or its surroundings: the elbow for a vertex of
/// the elbow, but not the shoulder. Of blend shapes those that move the surroundings, of a sequence its one control.
/// `rings`: how far the surroundings reach, in edges; vertices farther off take what their neighbors have. Groups in
/// order of their first vertex.
std::vector<InfluenceGroup> possible_influences(const Animation& animation, const StateReader& reader, int rings);

struct InfluenceTest {
    double significance = 0.05;  ///< a control is kept if chance explains its gain with less than this probability
    double least_gain = 1e-3;    ///< and if its gain is at least this share of what the vertex varies
};
/// Drops the controls that do not matter, by an F-test per vertex and control on the mean curvature (Sec. 5.4.3), with
/// quadratic features: of all controls against all but that one. Where none passes, the one with which alone the fit is
/// best stays. `mean_curvature`: poses x vertices; vertices with varies[v] false get no control.
std::vector<InfluenceGroup> tested_influences(const std::vector<InfluenceGroup>& possible, const StateReader& reader,
                                              const Eigen::Ref<const Eigen::MatrixXf>& states,
                                              const Eigen::Ref<const Eigen::MatrixXf>& mean_curvature,
                                              const std::vector<bool>& varies, const InfluenceTest& options);

}  // namespace exemplar
