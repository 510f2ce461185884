#include "host/curvature/state/samples.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/half.h"
#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/core/statistics.h"
#include "host/core/text.h"
#include "host/lines/extraction/lines.h"
#include "host/mesh/topology.h"

namespace exemplar {

namespace {

std::vector<std::string> clip_names(const Animation& animation) {
    std::vector<std::string> names;
    for (const Clip& clip : animation.clips) names.push_back(clip.name);
    return names;
}

std::vector<std::uint32_t> selected_clips(const Animation& animation, const std::vector<std::string>& wanted) {
    const std::vector<std::string> names = clip_names(animation);
    std::vector<std::uint32_t> clips;
    for (std::uint32_t c = 0; c < names.size(); ++c)
        if (wanted.empty() || std::find(wanted.begin(), wanted.end(), names[c]) != wanted.end()) clips.push_back(c);
    for (const std::string& name : wanted)
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw UsageError(fmt::format("{} has no clip '{}'{}; it has: {}", animation.name, name,
                                         suggestion(name, names), fmt::join(names, ", ")));
    return clips;
}

/// The mean of unit vectors, `fallback` where they cancel.
Vec3 unit_or(const Vec3& sum, const Vec3& fallback) {
    const float length = sum.norm();
    return length > 1e-6f ? Vec3(sum / length) : fallback;
}

/// Rounds as a model file does, so that training and use derive the same tangent from it. No zero is negative.
Vec3 as_halves(const Vec3& v) {
    return v.unaryExpr([](float value) { return from_half(to_half(value)); });
}

/// Per-vertex sums over poses from which the frames of attributes are computed.
struct FrameSums {
    std::vector<Vec3> normal;
    std::vector<Eigen::Matrix3f> direction;  ///< of e1 e1^T, which does not depend on the sign
};

AttributeFrames make_principal_frames(const Segments& segments, const FrameSums& sums) {
    AttributeFrames frames;
    frames.set = AttributeSet::principal;
    frames.segment = segments.segment_of_vertex;
    for (const Vec3& sum : sums.normal) frames.reference_normal.push_back(as_halves(unit_or(sum, Vec3::UnitZ())));
    for (const Eigen::Matrix3f& sum : sums.direction)
        frames.reference_direction.emplace_back(
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f>(sum).eigenvectors().col(2));
    return frames;
}

FrameSums sum_frames(const std::vector<SurfaceSnapshot>& snapshots, const Segments& segments) {
    const std::size_t count = segments.segment_of_vertex.size();
    FrameSums sums{std::vector<Vec3>(count, Vec3::Zero()),
                   std::vector<Eigen::Matrix3f>(count, Eigen::Matrix3f::Zero())};
    parallel_for(
        count,
        [&](std::size_t v) {
            for (const SurfaceSnapshot& snapshot : snapshots) {
                const Eigen::Matrix3f to_segment = snapshot.rotations[segments.segment_of_vertex[v]].transpose();
                const Vec3 e1 = to_segment * snapshot.curvature.e1[v];
                sums.normal[v] += to_segment * snapshot.normals[v];
                sums.direction[v] += e1 * e1.transpose();
            }
        },
        1024);
    return sums;
}

/// Returns for each vertex the neighbor whose edge stays closest to the tangent plane: the minimum over all frames
/// of the tangential share of its squared length is largest. An edge nearly parallel to the normal, as in a fold,
/// has no reliable tangent direction. Returns the vertex itself if it has no neighbors.
std::vector<std::uint32_t> steadiest_neighbors(const TriangleMesh& rest,
                                               const std::vector<SurfaceSnapshot>& snapshots) {
    const Topology topology = build_topology(rest);
    std::vector<float> flatness(topology.edges.size() * 2, 1.0f);  // from either end
    parallel_for(
        topology.edges.size(),
        [&](std::size_t e) {
            const auto [a, b] = topology.edges[e].vertex;
            for (const SurfaceSnapshot& snapshot : snapshots) {
                const Vec3 edge = snapshot.vertices[b] - snapshot.vertices[a];
                const float squared = std::max(edge.squaredNorm(), std::numeric_limits<float>::min());
                const auto flat = [&](std::uint32_t v) {
                    const float upright = edge.dot(snapshot.normals[v]);
                    return 1 - upright * upright / squared;
                };
                flatness[2 * e] = std::min(flatness[2 * e], flat(a));
                flatness[2 * e + 1] = std::min(flatness[2 * e + 1], flat(b));
            }
        },
        512);
    std::vector<std::uint32_t> neighbor(rest.vertex_count());
    std::iota(neighbor.begin(), neighbor.end(), 0u);
    std::vector<float> best(rest.vertex_count(), -1.0f);
    for (std::size_t e = 0; e < topology.edges.size(); ++e)
        for (std::size_t end = 0; end < 2; ++end) {
            const std::uint32_t v = topology.edges[e].vertex[end];
            if (!(flatness[2 * e + end] > best[v])) continue;
            best[v] = flatness[2 * e + end];
            neighbor[v] = topology.edges[e].vertex[1 - end];
        }
    return neighbor;
}

}  // namespace

std::vector<FrameRef> select_frames(const Animation& animation, const FrameSelection& selection) {
    std::vector<FrameRef> frames;
    for (const std::uint32_t clip : selected_clips(animation, selection.clips)) {
        const std::size_t end = std::min(selection.end, animation.clips[clip].size());
        for (std::size_t f = selection.begin; f < end; ++f) frames.push_back({clip, static_cast<std::uint32_t>(f)});
    }
    if (frames.empty())
        throw UsageError(fmt::format("{} has no frame that was asked for; its clips are: {}", animation.name,
                                     fmt::join(clip_names(animation), ", ")));
    return evenly_spaced(frames, selection.most);
}

SnapshotReader::SnapshotReader(const Animation& animation, const Segments& segments, const CurvatureOptions& truth)
    : animation_(&animation),
      segments_(&segments),
      truth_(truth),
      estimator_(animation.rest.faces, animation.rest.vertex_count()) {
    if (truth_.smoothing_unit <= 0) truth_.smoothing_unit = estimator_.median_edge_length(animation.rest.vertices);
}

SurfaceSnapshot SnapshotReader::read(FrameRef frame) {
    SurfaceSnapshot snapshot;
    const Clip& clip = animation_->clips[frame.clip];
    snapshot.vertices = frame_vertices(*animation_, clip, frame.frame);
    if (segments_->influence_begin.empty())
        segments_->rotations_of_sequence(snapshot.vertices, snapshot.rotations);
    else
        segments_->rotations_of_rig(bone_transforms(animation_->rig, clip.poses[frame.frame]), snapshot.rotations);
    snapshot.curvature = estimator_.estimate(snapshot.vertices, truth_);
    snapshot.normals = estimator_.normals();
    return snapshot;
}

TriangleMesh layout_shape(const Animation& animation, FrameRef frame) {
    TriangleMesh shape = animation.rest;
    if (animation.kind != AnimationKind::sequence)
        shape.vertices = frame_vertices(animation, animation.clips[frame.clip], frame.frame);
    return shape;
}

TriangleMesh first_shape(const Animation& animation) {
    TriangleMesh shape = animation.rest;
    std::size_t clip = 0;
    while (clip < animation.clips.size() && animation.clips[clip].size() == 0) ++clip;
    shape.vertices = vertices_of(animation, shape_at(animation, clip, 0));
    return shape;
}

Segments segment_animation(const Animation& animation, std::span<const FrameRef> frames) {
    if (animation.kind != AnimationKind::sequence) return segment_rig(animation.rig, animation.rest.vertex_count());
    std::vector<std::vector<Vec3>> positions;
    for (const FrameRef& frame : frames) positions.push_back(animation.clips[frame.clip].frames[frame.frame]);
    return segment_sequence(animation.rest, positions);
}

StateReader make_state(const Animation& animation, std::span<const FrameRef> frames,
                       const SequenceStateOptions& options) {
    if (animation.kind == AnimationKind::sequence) {
        std::vector<std::vector<Vec3>> positions;
        for (const FrameRef& frame : frames) positions.push_back(animation.clips[frame.clip].frames[frame.frame]);
        return make_sequence_state(animation.rest, positions, options);
    }
    std::vector<const Pose*> poses;
    for (const FrameRef& frame : frames) poses.push_back(&animation.clips[frame.clip].poses[frame.frame]);
    return make_rig_state(animation, poses);
}

void read_state(const StateReader& reader, const Animation& animation, FrameRef frame, const SurfaceSnapshot& snapshot,
                std::span<float> x) {
    if (animation.kind == AnimationKind::sequence)
        reader.read_surface(snapshot.vertices, snapshot.normals, snapshot.rotations, x);
    else
        reader.read_pose(animation.clips[frame.clip].poses[frame.frame], x);
}

std::vector<SurfaceSnapshot> read_snapshots(const Animation& animation, const Segments& segments,
                                            std::span<const FrameRef> frames, const CurvatureOptions& truth) {
    std::vector<SurfaceSnapshot> snapshots(frames.size());
    Progress progress("measuring curvature", frames.size());
    parallel_ranges(frames.size(), 8, [&](std::size_t begin, std::size_t end) {
        SnapshotReader reader(animation, segments, truth);
        for (std::size_t i = begin; i < end; ++i) {
            snapshots[i] = reader.read(frames[i]);
            progress.advance();
        }
    });
    return snapshots;
}

AttributeFrames make_attribute_frames(AttributeSet set, const TriangleMesh& rest, const Segments& segments,
                                      const std::vector<SurfaceSnapshot>& snapshots) {
    if (set == AttributeSet::principal) return make_principal_frames(segments, sum_frames(snapshots, segments));
    AttributeFrames frames;
    frames.neighbor = steadiest_neighbors(rest, snapshots);
    return frames;
}

double percentile_99(const Eigen::VectorXd& values) {
    std::vector<double> sorted(values.begin(), values.end());
    return quantile(sorted, 0.99);
}

Eigen::MatrixXf deviations(const std::vector<Eigen::MatrixXf>& attributes, const Eigen::MatrixXf& means) {
    Eigen::MatrixXf result(means.rows(), means.cols());
    for (Eigen::Index a = 0; a < means.rows(); ++a) {
        const Eigen::MatrixXf& values = attributes[static_cast<std::size_t>(a)];
        for (Eigen::Index v = 0; v < means.cols(); ++v)
            result(a, v) = std::sqrt((values.col(v).array() - means(a, v)).square().mean());
    }
    return result;
}

Eigen::MatrixXf error_scales(Eigen::MatrixXf deviations) {
    constexpr double k_min_share = 0.0005;
    for (Eigen::Index a = 0; a < deviations.rows(); ++a) {
        const double most = percentile_99(deviations.row(a).transpose().cast<double>());
        deviations.row(a) = deviations.row(a).cwiseMax(static_cast<float>(std::max(k_min_share * most, 1e-20)));
    }
    return deviations;
}

TrainingSamples collect_samples(const Animation& animation, const Segments& segments, const StateReader& reader,
                                std::span<const FrameRef> frames, AttributeSet set, const CurvatureOptions& truth) {
    const std::vector<SurfaceSnapshot> snapshots = read_snapshots(animation, segments, frames, truth);
    TrainingSamples samples;
    samples.frames = make_attribute_frames(set, animation.rest, segments, snapshots);
    const std::size_t count = animation.rest.vertex_count();
    const auto poses = static_cast<Eigen::Index>(frames.size());
    samples.attributes.assign(attribute_count(set), Eigen::MatrixXf(poses, static_cast<Eigen::Index>(count)));
    samples.states.resize(poses, static_cast<Eigen::Index>(reader.input_count));
    std::vector<float> attributes(count * attribute_count(set)), x(reader.input_count);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const SurfaceSnapshot& snapshot = snapshots[i];
        const auto row = static_cast<Eigen::Index>(i);
        samples.frames.encode(snapshot.curvature, snapshot.surface(), attributes);
        for (std::size_t a = 0; a < samples.attributes.size(); ++a)
            samples.attributes[a].row(row) =
                Eigen::Map<const Eigen::RowVectorXf>(attributes.data() + a * count, static_cast<Eigen::Index>(count));
        read_state(reader, animation, frames[i], snapshot, x);
        samples.states.row(row) = Eigen::Map<const Eigen::RowVectorXf>(x.data(), static_cast<Eigen::Index>(x.size()));
        samples.feature_size += feature_size(snapshot.vertices, snapshot.curvature) / static_cast<float>(frames.size());
    }
    return samples;
}

}  // namespace exemplar
