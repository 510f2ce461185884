#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "host/animation/animation.h"
#include "host/curvature/state/state.h"

namespace exemplar {

/// Vertices whose curvature depends on the same controls.
struct InfluenceGroup {
    std::vector<std::uint32_t> controls;  ///< ascending; none for vertices that do not change
    std::vector<std::uint32_t> vertices;  ///< ascending
};

/// Returns the controls that can influence each vertex, as groups in order of their first vertex. The neighborhood
/// of a vertex reaches `rings` edges. Curvature is invariant under rigid motion, so a skeleton's controls of a
/// vertex are the joints on the paths between the bones of its neighborhood: near the elbow the elbow joint, but not
/// the shoulder. Blend shapes: those that move the neighborhood. Sequences: the vertex' patch. Vertices without any
/// take their neighbors' controls.
std::vector<InfluenceGroup> candidate_influences(const Animation& animation, const StateReader& reader, int rings);

struct InfluenceTest {
    double significance = 0.05;  ///< a control is kept if the p-value of its gain is below this
    double min_gain = 1e-3;      ///< and if its gain is at least this share of the vertex' variation
};
/// Drops insignificant controls by an F-test per vertex and control on the mean curvature (Sec. 5.4.3). It compares
/// the fits with quadratic features of all controls and of all but that one. If none passes, the control that alone
/// fits best is kept. `mean_curvature`: poses x vertices. Vertices with varies[v] false get no control.
std::vector<InfluenceGroup> significant_influences(const std::vector<InfluenceGroup>& possible,
                                                   const StateReader& reader,
                                                   const Eigen::Ref<const Eigen::MatrixXf>& states,
                                                   const Eigen::Ref<const Eigen::MatrixXf>& mean_curvature,
                                                   const std::vector<bool>& varies, const InfluenceTest& options);

}  // namespace exemplar
