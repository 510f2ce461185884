// Curvature is the derivative of the normals, so it is nearly a linear map of the normals and positions around a
// vertex in a frame that moves with the surface. Each patch learns that map for all attributes of all its vertices
// at once, by reduced-rank regression: it finds the few directions of the shape that matter to curvature. Components
// of the shape alone (Sec. 5.5.1) are those that vary most, whether they matter to curvature or not.

#include "host/curvature/learning/learn_local.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/half.h"
#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/curvature/learning/model_builder.h"
#include "host/curvature/model/tiling.h"
#include "host/curvature/state/patches.h"
#include "host/learn/regression/reduced_rank.h"
#include "host/lines/extraction/lines.h"
#include "host/mesh/topology.h"

namespace exemplar {

namespace {

using Eigen::Index;
using Eigen::MatrixXf;

/// Rings around a patch whose shape is read, too, since curvature at its border depends on its surroundings.
constexpr int k_rings = 1;
/// A patch whose local shape deviates less than this from its mean (root mean square) does not bend: it is rounding.
constexpr double k_min_motion = 1e-5;
/// Ridge of the regression, relative to the variance of the shape.
constexpr double k_ridge = 1e-3;
/// A component that explains less than this share of the mean variance of a patch is dropped.
constexpr double k_min_explained = 2e-4;

using Neighbors = std::vector<std::vector<std::uint32_t>>;

Neighbors neighbors_of(const TriangleMesh& mesh) {
    Neighbors neighbors(mesh.vertex_count());
    for (const Edge& edge : build_topology(mesh).edges) {
        neighbors[edge.vertex[0]].push_back(edge.vertex[1]);
        neighbors[edge.vertex[1]].push_back(edge.vertex[0]);
    }
    return neighbors;
}

/// Returns a patch with k_rings around it, ascending.
std::vector<std::uint32_t> widened(std::vector<std::uint32_t> patch, const Neighbors& neighbors) {
    for (int ring = 0; ring < k_rings; ++ring) {
        const std::size_t before = patch.size();
        for (std::size_t i = 0; i < before; ++i)
            patch.insert(patch.end(), neighbors[patch[i]].begin(), neighbors[patch[i]].end());
        std::sort(patch.begin(), patch.end());
        patch.erase(std::unique(patch.begin(), patch.end()), patch.end());
    }
    return patch;
}

/// Returns about every third vertex: a maximal set in which no two are neighbors. Measured curvature is smooth over
/// about an edge, so the other vertices would add little, at three times the cost.
std::vector<std::uint32_t> thinned(const std::vector<std::uint32_t>& vertices, const Neighbors& neighbors) {
    std::vector<std::uint32_t> taken;  // ascending, like the vertices
    for (const std::uint32_t v : vertices)
        if (std::none_of(neighbors[v].begin(), neighbors[v].end(),
                         [&](std::uint32_t other) { return std::binary_search(taken.begin(), taken.end(), other); }))
            taken.push_back(v);
    return taken;
}

/// Returns each attribute of all vertices in all frames: poses x vertices.
std::vector<MatrixXf> encode_all(const AttributeFrames& frames, const std::vector<SurfaceSnapshot>& snapshots) {
    const std::size_t count = frames.vertex_count(), attributes = attribute_count(frames.set);
    std::vector<MatrixXf> result(attributes, MatrixXf(Index(snapshots.size()), Index(count)));
    std::vector<float> values(count * attributes);
    for (std::size_t i = 0; i < snapshots.size(); ++i) {
        frames.encode(snapshots[i].curvature, snapshots[i].surface(), values);
        for (std::size_t a = 0; a < attributes; ++a)
            result[a].row(Index(i)) = Eigen::Map<const Eigen::RowVectorXf>(values.data() + a * count, Index(count));
    }
    return result;
}

class LocalLearner {
  public:
    LocalLearner(const std::vector<SurfaceSnapshot>& snapshots, std::size_t real, const AttributeFrames& frames,
                 std::size_t max_inputs, StateReader& reader)
        : moments_(snapshots),
          real_(Index(real)),
          max_inputs_(max_inputs),
          reader_(reader),
          local_(std::get<LocalShapeState>(reader.source)),
          attributes_(encode_all(frames, snapshots)),
          means_(Index(attributes_.size()), Index(frames.vertex_count())),
          patches_(local_.begin.size() - 1) {
        for (std::size_t a = 0; a < attributes_.size(); ++a)
            means_.row(Index(a)) = attributes_[a].topRows(real_).colwise().mean();
        scales_ = error_scales(deviations(attributes_, means_));
        for (std::size_t a = 0; a < attributes_.size(); ++a) {
            attributes_[a].rowwise() -= means_.row(Index(a));
            attributes_[a] *= scales_.row(Index(a)).cwiseInverse().asDiagonal();
        }
        for (std::uint32_t v = 0; v < frames.vertex_count(); ++v) patches_[frames.segment[v]].push_back(v);
    }

    /// Learns the reader's maps and inputs. Returns a builder with the bases.
    PredictorBuilder learn() {
        local_.mean.resize(patches_.size());
        std::vector<ReducedRank> maps(patches_.size());
        Progress progress("fitting", patches_.size());
        parallel_for(patches_.size(), [&](std::size_t p) {
            maps[p] = fit_patch(p);
            progress.advance();
        });
        progress.finish();
        for (std::size_t p = 0; p < patches_.size(); ++p) {
            keep_strongest(maps[p]);
            const auto inputs = static_cast<std::uint32_t>(maps[p].projection.rows());
            reader_.controls.push_back(
                {"patch " + std::to_string(p), static_cast<std::uint32_t>(reader_.input_count), inputs});
            reader_.input_count += inputs;
            // Files hold halves.
            local_.map.push_back(maps[p].projection.unaryExpr([](float value) { return from_half(to_half(value)); }));
        }
        PredictorBuilder builder(reader_.input_count);
        for (std::size_t p = 0; p < patches_.size(); ++p) add_bases(p, maps[p], builder);
        return builder;
    }

    const MatrixXf& means() const { return means_; }
    const MatrixXf& scales() const { return scales_; }
    PoseRange range() const { return make_pose_range(reader_, states(), static_cast<std::size_t>(real_)); }

  private:
    /// Computes x of all frames: poses x inputs.
    MatrixXf states() const {
        MatrixXf states(Index(moments_.size()), Index(reader_.input_count));
        std::vector<float> x(reader_.input_count);
        for (std::size_t i = 0; i < moments_.size(); ++i) {
            const SurfaceSnapshot& snapshot = moments_[i];
            reader_.read_surface(snapshot.vertices, snapshot.normals, snapshot.rotations, x);
            states.row(Index(i)) = Eigen::Map<const Eigen::RowVectorXf>(x.data(), Index(x.size()));
        }
        return states;
    }

    /// poses x local shape
    MatrixXf shapes(std::size_t patch) const {
        Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> result(Index(moments_.size()),
                                                                                     Index(local_.size(patch)));
        for (std::size_t i = 0; i < moments_.size(); ++i)
            local_.read(patch, moments_[i].vertices, moments_[i].normals, moments_[i].rotations[patch],
                        {result.data() + i * local_.size(patch), local_.size(patch)});
        return result;
    }

    ReducedRank fit_patch(std::size_t patch) {
        MatrixXf x = shapes(patch);
        local_.mean[patch] = x.topRows(real_).colwise().mean().transpose();
        x.rowwise() -= local_.mean[patch].transpose();
        if (x.squaredNorm() < k_min_motion * k_min_motion * static_cast<double>(x.size())) x.setZero();
        const std::vector<std::uint32_t>& vertices = patches_[patch];
        MatrixXf y(x.rows(), Index(vertices.size() * attributes_.size()));
        for (std::size_t a = 0; a < attributes_.size(); ++a)
            for (std::size_t i = 0; i < vertices.size(); ++i)
                y.col(Index(a * vertices.size() + i)) = attributes_[a].col(vertices[i]);
        return fit_reduced_rank(x, y, k_ridge, max_inputs_);
    }

    /// Drops components that explain little. An attribute of a vertex has a variance of at most 1.
    void keep_strongest(ReducedRank& map) const {
        const double mean = static_cast<double>(means_.size()) / static_cast<double>(patches_.size());
        Index kept = 0;
        while (kept < map.explained.size() && map.explained[kept] > k_min_explained * mean) ++kept;
        map.projection.conservativeResize(kept, Eigen::NoChange);
        map.basis.conservativeResize(Eigen::NoChange, kept);
        map.explained.conservativeResize(kept);
    }

    void add_bases(std::size_t patch, const ReducedRank& map, PredictorBuilder& builder) const {
        const Control& control = reader_.controls[patch];
        if (control.input_count == 0) return;  // it does not bend
        const auto one = static_cast<std::uint32_t>(reader_.input_count);
        std::vector<Monomial> inputs;
        for (std::uint32_t i = 0; i < control.input_count; ++i) inputs.push_back({control.first_input + i, one, one});
        const std::uint32_t first = builder.add_inputs(inputs);
        const auto count = Index(patches_[patch].size());
        for (std::size_t a = 0; a < attributes_.size(); ++a) {
            MatrixXf basis = map.basis.middleRows(Index(a) * count, count);
            for (Index i = 0; i < count; ++i) basis.row(i) *= scales_(Index(a), patches_[patch][std::size_t(i)]);
            builder.add_shared_basis(a, patches_[patch], basis, first);
        }
    }

    const std::vector<SurfaceSnapshot>& moments_;
    Index real_;
    std::size_t max_inputs_;
    StateReader& reader_;
    LocalShapeState& local_;            // of the reader
    std::vector<MatrixXf> attributes_;  // centered, over their scales
    MatrixXf means_, scales_;           // attributes x vertices
    std::vector<std::vector<std::uint32_t>> patches_;
};

/// Builds the reader of the local shape of patches, without the learned maps.
StateReader local_reader(const TriangleMesh& rest, const Segments& segments, float unit) {
    LocalShapeState local;
    local.unit = unit;
    std::vector<std::vector<std::uint32_t>> patches(segments.count());
    for (std::uint32_t v = 0; v < rest.vertex_count(); ++v) patches[segments.segment_of_vertex[v]].push_back(v);
    const Neighbors neighbors = neighbors_of(rest);
    local.begin.push_back(0);
    for (const std::vector<std::uint32_t>& patch : patches) {
        const std::vector<std::uint32_t> vertices = thinned(widened(patch, neighbors), neighbors);
        local.vertex.insert(local.vertex.end(), vertices.begin(), vertices.end());
        local.begin.push_back(static_cast<std::uint32_t>(local.vertex.size()));
    }
    StateReader reader;
    reader.control_of_vertex = segments.segment_of_vertex;
    reader.source = std::move(local);
    return reader;
}

}  // namespace

void learn_local(const Animation& animation, std::span<const FrameRef> frames, std::size_t real,
                 const CurvatureTraining& options, CurvatureModel& model, CurvatureTrainingReport& report) {
    Stopwatch watch;
    const TriangleMesh rest = layout_shape(animation, frames.front());
    model.segments = segment_patches(rest, surface_patches(rest, options.sequence.patch_vertices));
    const std::size_t most = model.segments.count() * options.sequence.max_inputs;
    if (most > k_max_components)  // before all the work
        throw UsageError(
            fmt::format("{}: {} patches of up to {} inputs are more than a model can number ({}); make patches larger "
                        "(--patch) or allow them fewer inputs (--patch-inputs)",
                        animation.name, model.segments.count(), options.sequence.max_inputs, k_max_components));
    const auto unit = static_cast<float>(model.truth.smoothing_unit);
    model.state = local_reader(rest, model.segments, unit > 0 ? unit : 1.0f);
    const std::vector<SurfaceSnapshot> snapshots = read_snapshots(animation, model.segments, frames, model.truth);
    for (const SurfaceSnapshot& snapshot : snapshots)
        model.feature_size += feature_size(snapshot.vertices, snapshot.curvature) / static_cast<float>(frames.size());
    report.seconds_truth = watch.wall();

    watch = Stopwatch();
    AttributeFrames attribute_frames = make_attribute_frames(options.attributes, rest, model.segments, snapshots);
    attribute_frames.segment = model.segments.segment_of_vertex;  // so that tiles hold vertices of one patch only
    LocalLearner learner(snapshots, real, attribute_frames, options.sequence.max_inputs, model.state);
    const PredictorBuilder builder = learner.learn();
    if (model.state.input_count == 0)
        throw UsageError(fmt::format("{}: nothing bends in the {} poses given; name other clips or frames",
                                     animation.name, frames.size()));
    model.range = learner.range();
    model.regression = builder.regression();
    model.tiles = make_tiles(attribute_frames, rest.vertices, learner.means(), builder.bases(),
                             {.dropped_variance = options.dropped_variance, .scales = learner.scales()});
    report.seconds_fit = watch.wall();
    report.varying_vertices = model.vertex_count;
    report.possible_controls = report.kept_controls = 1;
}

}  // namespace exemplar
