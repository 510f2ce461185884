#include "host/curvature/model/evaluation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/core/statistics.h"
#include "host/lines/extraction/face_types.h"

namespace exemplar {

namespace {

constexpr std::array<LineType, 6> k_compared{
    LineType::suggestive_contours, LineType::suggestive_highlights, LineType::ridges, LineType::valleys,
    LineType::apparent_ridges,     LineType::principal_highlights};

/// The accumulated errors of one attribute. Percentiles are over a sample of them, so that memory does not grow with
/// the length of a motion.
struct ErrorSum {
    double squares = 0, count = 0;
    std::vector<float> magnitudes;
    void add(float error, bool keeps) {
        squares += double(error) * error;
        ++count;
        if (keeps) magnitudes.push_back(std::abs(error));
    }
    void add(const ErrorSum& other) {
        squares += other.squares;
        count += other.count;
        magnitudes.insert(magnitudes.end(), other.magnitudes.begin(), other.magnitudes.end());
    }
    double rms() const { return count > 0 ? std::sqrt(squares / count) : 0; }
    double percentile_95() { return quantile(magnitudes, 0.95); }
};

constexpr std::array<const char*, 7> k_names{"k1", "k2", "direction", "C111", "C112", "C122", "C222"};
using Errors = std::array<ErrorSum, k_names.size()>;

void add_errors(const VertexCurvature& truth, const VertexCurvature& guess, std::size_t stride, Errors& errors) {
    double difference = 0;
    for (std::size_t v = 0; v < truth.k1.size(); ++v) difference += double(truth.k1[v]) - truth.k2[v];
    const auto distinct =
        static_cast<float>(difference / static_cast<double>(std::max<std::size_t>(truth.k1.size(), 1)));
    for (std::size_t v = 0; v < truth.k1.size(); ++v) {
        const bool keeps = v % stride == 0;
        errors[0].add(guess.k1[v] - truth.k1[v], keeps);
        errors[1].add(guess.k2[v] - truth.k2[v], keeps);
        const float along = truth.e1[v].dot(guess.e1[v]), sign = along < 0 ? -1.0f : 1.0f;
        if (truth.k1[v] - truth.k2[v] >= distinct)
            errors[2].add(std::acos(std::min(std::abs(along), 1.0f)) * 180 / std::numbers::pi_v<float>, keeps);
        for (std::size_t k = 0; k < 4; ++k)
            errors[3 + k].add(sign * guess.derivative[v][k] - truth.derivative[v][k], keeps);
    }
}

struct LineDifferences {
    LineDifference learned{k_compared}, zero_order{k_compared};
};

void compare_lines(const std::vector<Face>& faces, const SurfaceSnapshot& snapshot, const VertexCurvature& learned,
                   const VertexCurvature& zero_order, float feature_size, LineDifferences& differences) {
    std::vector<LineType> seen, fixed;
    for (const LineType type : k_compared) (depends_on_view(type) ? seen : fixed).push_back(type);
    const std::array<const VertexCurvature*, 3> curvatures{&snapshot.curvature, &learned, &zero_order};
    const auto add = [&](std::size_t i, std::span<const LineType> types, const Vec3& eye, FaceTypes& of) {
        add_face_types({faces, snapshot.vertices, snapshot.normals, *curvatures[i]}, types,
                       {.eye = eye, .feature_size = feature_size, .thresholds = {}}, of);
    };
    std::array<FaceTypes, 3> from_anywhere, from_eye;
    for (std::size_t i = 0; i < curvatures.size(); ++i) {
        from_anywhere[i].resize(faces.size());
        add(i, fixed, Vec3::Zero(), from_anywhere[i]);
    }
    for (const Vec3& eye : eyes_around(snapshot.vertices)) {
        from_eye = from_anywhere;
        for (std::size_t i = 0; i < curvatures.size(); ++i) add(i, seen, eye, from_eye[i]);
        differences.learned.add(from_eye[0], from_eye[1]);
        differences.zero_order.add(from_eye[0], from_eye[2]);
    }
}

/// Accumulated results of some frames.
struct Tally {
    Errors learned, zero_order, truth;
    LineDifferences lines;
    PoseRange::Farthest farthest;
    std::size_t far_frames = 0;

    void add(const Tally& other) {
        for (std::size_t i = 0; i < learned.size(); ++i) {
            learned[i].add(other.learned[i]);
            zero_order[i].add(other.zero_order[i]);
            truth[i].add(other.truth[i]);
        }
        lines.learned.add(other.lines.learned);
        lines.zero_order.add(other.lines.zero_order);
        if (other.farthest.distance > farthest.distance) farthest = other.farthest;
        far_frames += other.far_frames;
    }
};

const VertexCurvature& evaluate_frame(CurvatureEvaluator& evaluator, const Animation& animation, FrameRef frame,
                                      const SurfaceSnapshot& snapshot) {
    return evaluator.evaluate(animation.rig, shape_at(animation, frame.clip, frame.frame), snapshot.vertices,
                              snapshot.normals);
}

/// Computes the curvature with all components at their mean.
void predict_zero_order(const CurvatureModel& model, const SurfaceSnapshot& snapshot, VertexCurvature& curvature) {
    const std::vector<float> nothing(model.regression.components.size(), 0.0f);
    reproject_curvature(model.tiles, nothing, snapshot.surface(), curvature);
}

/// Compares frame after frame, on one thread.
class FrameComparison {
  public:
    /// Percentiles are over the errors of every stride-th vertex.
    FrameComparison(const CurvatureModel& model, const Animation& animation, std::size_t stride)
        : model_(model),
          animation_(animation),
          reader_(animation, model.segments, model.truth),
          evaluator_(model),
          stride_(stride) {}

    void compare(FrameRef frame, Tally& tally) {
        const SurfaceSnapshot snapshot = reader_.read(frame);
        const VertexCurvature& learned = evaluate_frame(evaluator_, animation_, frame, snapshot);
        predict_zero_order(model_, snapshot, mean_);
        add_errors(snapshot.curvature, learned, stride_, tally.learned);
        add_errors(snapshot.curvature, mean_, stride_, tally.zero_order);
        for (std::size_t v = 0; v < snapshot.curvature.k1.size(); ++v) {
            tally.truth[0].squares += double(snapshot.curvature.k1[v]) * snapshot.curvature.k1[v];
            tally.truth[1].squares += double(snapshot.curvature.k2[v]) * snapshot.curvature.k2[v];
            for (std::size_t k = 0; k < 4; ++k)
                tally.truth[3 + k].squares +=
                    double(snapshot.curvature.derivative[v][k]) * snapshot.curvature.derivative[v][k];
        }
        compare_lines(animation_.rest.faces, snapshot, learned, mean_, model_.feature_size, tally.lines);
        const PoseRange::Farthest farthest = evaluator_.farthest();
        if (farthest.distance > tally.farthest.distance) tally.farthest = farthest;
        tally.far_frames += farthest.distance > k_far_pose;
    }

  private:
    const CurvatureModel& model_;
    const Animation& animation_;
    SnapshotReader reader_;
    CurvatureEvaluator evaluator_;
    std::size_t stride_;
    VertexCurvature mean_;
};

}  // namespace

std::span<const LineType> compared_lines() {
    return k_compared;
}

std::array<Vec3, 6> eyes_around(std::span<const Vec3> vertices) {
    Vec3 low = vertices.front(), high = vertices.front();
    for (const Vec3& p : vertices) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const Vec3 center = 0.5f * (low + high);
    const float distance = 1.5f * (high - low).norm();
    std::array<Vec3, 6> eyes;
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        // Off the axes, since models tend to be symmetric along them.
        Vec3 direction(0.31f, 0.22f, -0.27f);
        direction[static_cast<Eigen::Index>(i / 2)] = i % 2 ? -1.0f : 1.0f;
        eyes[i] = center + distance * direction.normalized();
    }
    return eyes;
}

FrameCurvature curvature_at(const CurvatureModel& model, const Animation& animation, FrameRef frame) {
    require_compatible(model, animation);
    FrameCurvature result{SnapshotReader(animation, model.segments, model.truth).read(frame), {}, {}};
    CurvatureEvaluator evaluator(model);
    result.learned = evaluate_frame(evaluator, animation, frame, result.snapshot);
    predict_zero_order(model, result.snapshot, result.zero_order);
    return result;
}

CurvatureEvaluation evaluate_curvature(const CurvatureModel& model, const Animation& animation,
                                       std::span<const FrameRef> frames) {
    require_compatible(model, animation);
    // Fixed chunks of frames, so that sums do not depend on the number of threads.
    constexpr std::size_t k_chunk = 8, k_max_kept = 4'000'000;
    const std::size_t stride = 1 + frames.size() * model.vertex_count / k_max_kept;
    std::vector<Tally> tallies((frames.size() + k_chunk - 1) / k_chunk);
    Progress progress("comparing frames", frames.size());
    parallel_for(tallies.size(), [&](std::size_t chunk) {
        FrameComparison comparison(model, animation, stride);
        for (std::size_t i = chunk * k_chunk; i < std::min(frames.size(), (chunk + 1) * k_chunk); ++i) {
            comparison.compare(frames[i], tallies[chunk]);
            progress.advance();
        }
    });
    Tally sum;
    for (const Tally& tally : tallies) sum.add(tally);

    CurvatureEvaluation result;
    result.frames = frames.size();
    const double values = std::max(1.0, double(frames.size()) * double(model.vertex_count));
    for (std::size_t i = 0; i < k_names.size(); ++i)
        result.attributes.push_back({k_names[i], sum.learned[i].rms(), sum.learned[i].percentile_95(),
                                     sum.zero_order[i].rms(), sum.zero_order[i].percentile_95(),
                                     std::sqrt(sum.truth[i].squares / values)});
    for (const LineType type : k_compared) {
        const LineDifference::Shares learned = sum.lines.learned.of(type);
        result.lines.push_back(
            {type, learned.truth, learned.misclassified, sum.lines.zero_order.of(type).misclassified});
    }
    result.farthest_pose = sum.farthest.distance;
    if (sum.farthest.control < model.state.controls.size())
        result.farthest_control = model.state.controls[sum.farthest.control].name;
    result.far_frames = sum.far_frames;
    return result;
}

}  // namespace exemplar
