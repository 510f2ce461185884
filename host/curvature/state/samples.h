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

/// One moment of an animation.
struct FrameRef {
    std::uint32_t clip = 0, frame = 0;
};

/// What is taken of an animation.
struct FrameSelection {
    std::vector<std::string> clips;  ///< by name; empty takes all
    std::size_t begin = 0;           ///< frames [begin, end) of each clip, cut to its length
    std::size_t end = static_cast<std::size_t>(-1);
    std::size_t most = static_cast<std::size_t>(-1);  ///< evenly taken, if there are more
};
/// The selected frames, in order. Throws UsageError naming the clips there are if one is not known, or if none is left.
std::vector<FrameRef> select_frames(const Animation& animation, const FrameSelection& selection);

/// The surface at one moment, and its measured curvature.
struct SurfaceMoment {
    std::vector<Vec3> vertices, normals;
    VertexCurvature curvature;
    std::vector<Eigen::Matrix3f> rotations;  ///< of the segments

    PosedSurface surface() const { return {vertices, normals, rotations}; }
};

/// Reads moments of an animation. One thread at a time may use a reader.
class MomentReader {
  public:
    /// truth: how curvature is measured.
    MomentReader(const Animation& animation, const Segments& segments, const CurvatureOptions& truth);
    /// The surface at a frame.
    SurfaceMoment read(FrameRef frame);

  private:
    const Animation* animation_;
    const Segments* segments_;
    CurvatureOptions truth_;
    CurvatureEstimator estimator_;
};

/// The shape that patches and tiles are laid out on: of a rig the pose at a frame, as its bind space may be no shape at
/// all.
TriangleMesh layout_shape(const Animation& animation, FrameRef frame);
/// The shape at the first frame, or of the pose at rest if there is none: what the scale of a surface and nearness on
/// it are taken from, as frames may be far from the shape at rest.
TriangleMesh first_shape(const Animation& animation);
/// The segments of an animation: by weights, or by motion in the given frames of a sequence.
Segments segment_animation(const Animation& animation, std::span<const FrameRef> frames);
/// The reader of its state, made from the given frames.
StateReader make_state(const Animation& animation, std::span<const FrameRef> frames,
                       const SequenceStateOptions& options);
/// x of a frame, read before as a moment.
void read_state(const StateReader& reader, const Animation& animation, FrameRef frame, const SurfaceMoment& moment,
                std::span<float> x);
/// Moments of an animation with their curvature, on all cores.
std::vector<SurfaceMoment> read_moments(const Animation& animation, const Segments& segments,
                                        std::span<const FrameRef> frames, const CurvatureOptions& truth);
/// The frames of attributes that suit some moments with curvature.
AttributeFrames make_attribute_frames(AttributeSet set, const TriangleMesh& rest, const Segments& segments,
                                      const std::vector<SurfaceMoment>& moments);

/// Training poses: inputs and attributes.
struct TrainingSamples {
    AttributeFrames frames;
    Eigen::MatrixXf states;                   ///< poses x inputs
    std::vector<Eigen::MatrixXf> attributes;  ///< of each attribute: poses x vertices
    float feature_size = 0;                   ///< mean over the poses (see lines)
};
/// Standard deviation of each attribute at each vertex over the poses, about `means` (attributes x vertices): of the
/// same size.
Eigen::MatrixXf deviations(const std::vector<Eigen::MatrixXf>& attributes, const Eigen::MatrixXf& means);
/// What errors are counted in, so that gentle surfaces, where suggestive contours run, count as much as creases:
/// deviations, but at least a two-thousandth of the largest of the attribute: what changes less is rounding.
Eigen::MatrixXf error_scales(Eigen::MatrixXf deviations);
/// The largest value, but for the hundredth that are even larger: one crumpled face should not stand for a surface.
double largest_but_outliers(const Eigen::VectorXd& values);

TrainingSamples collect_samples(const Animation& animation, const Segments& segments, const StateReader& reader,
                                std::span<const FrameRef> frames, AttributeSet set, const CurvatureOptions& truth);

}  // namespace exemplar
