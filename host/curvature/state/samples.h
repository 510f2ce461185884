#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/animation/animation.h"
#include "host/curvature/state/attributes.h"
#include "host/curvature/state/segments.h"
#include "host/curvature/state/state.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar {

/// One frame of a clip of an animation.
struct FrameRef {
    std::uint32_t clip = 0, frame = 0;
};

/// Selects frames of an animation.
struct FrameSelection {
    std::vector<std::string> clips;  ///< by name; empty: all
    std::size_t begin = 0;           ///< frames [begin, end) of each clip, clamped to its length
    std::size_t end = static_cast<std::size_t>(-1);
    std::size_t most = static_cast<std::size_t>(-1);  ///< maximum number of frames; evenly spaced if there are more
};
/// Returns the selected frames in order. Throws UsageError listing the clips if a clip is unknown or no frame is
/// left.
std::vector<FrameRef> select_frames(const Animation& animation, const FrameSelection& selection);

/// The surface in one frame, with its measured curvature.
struct SurfaceSnapshot {
    std::vector<Vec3> vertices, normals;
    VertexCurvature curvature;
    std::vector<Eigen::Matrix3f> rotations;  ///< per segment

    PosedSurface surface() const { return {vertices, normals, rotations}; }
};

/// Reads frames of an animation and measures their curvature. Only one thread at a time may use a reader.
class SnapshotReader {
  public:
    /// truth: how curvature is measured.
    SnapshotReader(const Animation& animation, const Segments& segments, const CurvatureOptions& truth);
    /// Returns the surface in a frame.
    SurfaceSnapshot read(FrameRef frame);

  private:
    const Animation* animation_;
    const Segments* segments_;
    CurvatureOptions truth_;
    CurvatureEstimator estimator_;
};

/// Returns the shape that patches and tiles are laid out on. For a rig it is the pose at `frame`, since bind space
/// need not be a meaningful shape; for a sequence it is the shape at rest.
TriangleMesh layout_shape(const Animation& animation, FrameRef frame);
/// Returns the shape at the first frame, or in the rest pose if there are no frames. Scale and proximity are
/// measured on it, since frames may be far from the shape at rest.
TriangleMesh first_shape(const Animation& animation);
/// Computes the segments of an animation: of a rig by weights, of a sequence by its motion in the given frames.
Segments segment_animation(const Animation& animation, std::span<const FrameRef> frames);
/// Builds the reader of an animation's state from the given frames.
StateReader make_state(const Animation& animation, std::span<const FrameRef> frames,
                       const SequenceStateOptions& options);
/// Computes the inputs x of a frame; `moment` is the surface in that frame.
void read_state(const StateReader& reader, const Animation& animation, FrameRef frame, const SurfaceSnapshot& snapshot,
                std::span<float> x);
/// Reads frames of an animation with their measured curvature, in parallel.
std::vector<SurfaceSnapshot> read_snapshots(const Animation& animation, const Segments& segments,
                                            std::span<const FrameRef> frames, const CurvatureOptions& truth);
/// Chooses the frames of attributes from measured surfaces. tensor: per vertex the edge that stays closest to the
/// tangent plane; principal: mean normals and directions.
AttributeFrames make_attribute_frames(AttributeSet set, const TriangleMesh& rest, const Segments& segments,
                                      const std::vector<SurfaceSnapshot>& snapshots);

/// Training data: inputs and attributes of all poses.
struct TrainingSamples {
    AttributeFrames frames;
    Eigen::MatrixXf states;                   ///< poses x inputs
    std::vector<Eigen::MatrixXf> attributes;  ///< per attribute: poses x vertices
    float feature_size = 0;                   ///< mean over the poses (see lines)
};
/// Returns the standard deviation of each attribute at each vertex over the poses, about `means`. Result and
/// `means`: attributes x vertices.
Eigen::MatrixXf deviations(const std::vector<Eigen::MatrixXf>& attributes, const Eigen::MatrixXf& means);
/// Returns the units in which errors are measured: the deviations, but at least 1/2000 of the attribute's largest
/// one (without outliers), since smaller changes are rounding. In these units gentle surfaces, where suggestive
/// contours run, count as much as creases.
Eigen::MatrixXf error_scales(Eigen::MatrixXf deviations);
/// Returns the 99th percentile, so that one crumpled face does not set the scale of a surface.
double percentile_99(const Eigen::VectorXd& values);

TrainingSamples collect_samples(const Animation& animation, const Segments& segments, const StateReader& reader,
                                std::span<const FrameRef> frames, AttributeSet set, const CurvatureOptions& truth);

}  // namespace exemplar
