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

/// How far predictions are from measured curvature, over all vertices and frames; in units of the truth.
struct AttributeError {
    std::string name;
    double rms = 0, percentile_95 = 0;                        ///< of the learned curvature
    double zero_order_rms = 0, zero_order_percentile_95 = 0;  ///< of the mean of training in its place
    double truth_rms = 0;  ///< of the measured values themselves; zero for directions
};

/// Faces that carry a line by one curvature but not by the other, as a share of all faces, over frames and views.
struct LineError {
    LineType type = LineType::suggestive_contours;
    double truth = 0;  ///< share of the faces that carry a line
    double misclassified = 0, zero_order = 0;
};

struct CurvatureEvaluation {
    std::size_t frames = 0;
    /// k1, k2, direction (degrees between the first principal directions where the curvatures differ by at least the
    /// mean difference), C111, C112, C122, C222 (with the sign of the truth's e1).
    std::vector<AttributeError> attributes;
    std::vector<LineError> lines;
    double farthest_pose = 0;      ///< largest PoseRange distance; up to 1 is within training
    std::string farthest_control;  ///< of that pose
    std::size_t far_frames = 0;    ///< with a distance above k_far_pose
};

/// A pose beyond this distance (see PoseRange) is flagged: predictions are extrapolated there.
constexpr float k_far_pose = 1.5f;

/// Line types whose faces depend on curvature, which evaluations compare.
std::span<const LineType> compared_lines();
/// Where evaluations see a surface from: six sides, off the axes, at three times the radius of its bounding box.
std::array<Vec3, 6> eyes_around(std::span<const Vec3> vertices);

/// Compares a model with measured curvature on frames of an animation, ideally unseen ones. Seen from eyes_around().
CurvatureEvaluation evaluate_curvature(const CurvatureModel& model, const Animation& animation,
                                       std::span<const FrameRef> frames);

/// A frame with its measured curvature, beside what the model predicts and the mean of training.
struct FrameCurvature {
    SurfaceMoment moment;
    VertexCurvature learned, zero_order;
};
FrameCurvature curvature_at(const CurvatureModel& model, const Animation& animation, FrameRef frame);

}  // namespace exemplar
