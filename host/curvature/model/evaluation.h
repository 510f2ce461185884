#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "host/curvature/model/model.h"
#include "host/curvature/state/samples.h"
#include "host/lines/extraction/lines.h"

namespace exemplar {

/// Errors of predictions against measured curvature, over all vertices and frames, in units of the truth.
struct AttributeError {
    std::string name;
    double rms = 0, percentile_95 = 0;                        ///< of learned curvature
    double zero_order_rms = 0, zero_order_percentile_95 = 0;  ///< of the training mean as prediction
    double truth_rms = 0;                                     ///< of the measured values; zero for directions
};

/// Faces on which only one of two curvatures yields a line, as a share of all faces, over frames and views.
struct LineError {
    LineType type = LineType::suggestive_contours;
    double truth = 0;  ///< share of the faces with a line
    double misclassified = 0, zero_order = 0;
};

struct CurvatureEvaluation {
    std::size_t frames = 0;
    /// k1, k2, direction, C111, C112, C122, C222 (with the sign of the truth's e1). direction is the angle in
    /// degrees between the first principal directions, at vertices where k1 - k2 is at least its mean.
    std::vector<AttributeError> attributes;
    std::vector<LineError> lines;
    double farthest_pose = 0;      ///< largest PoseRange distance; up to 1 is within training
    std::string farthest_control;  ///< of that pose
    std::size_t far_frames = 0;    ///< with a distance above k_far_pose
};

/// Poses beyond this distance (see PoseRange) are flagged, since predictions are extrapolated there.
constexpr float k_far_pose = 1.5f;

/// Returns the line types that depend on curvature and that evaluations compare.
std::span<const LineType> compared_lines();
/// Returns the viewpoints of evaluations: six sides, off the axes, 1.5 diagonals of the bounding box away.
std::array<Vec3, 6> eyes_around(std::span<const Vec3> vertices);

/// Compares a model with measured curvature on frames of an animation, ideally unseen ones; lines are compared from
/// the viewpoints eyes_around(). Throws ModelError if the model does not fit (see require_compatible).
CurvatureEvaluation evaluate_curvature(const CurvatureModel& model, const Animation& animation,
                                       std::span<const FrameRef> frames);

/// A frame with its measured curvature, the predicted one and that of the training mean.
struct FrameCurvature {
    SurfaceSnapshot snapshot;
    VertexCurvature learned, zero_order;
};
FrameCurvature curvature_at(const CurvatureModel& model, const Animation& animation, FrameRef frame);

}  // namespace exemplar
