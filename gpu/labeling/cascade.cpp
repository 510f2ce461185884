#include "gpu/labeling/cascade.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "embedded/labeling_context_linear_comp.h"
#include "embedded/labeling_context_ranks_comp.h"
#include "embedded/labeling_prediction_comp.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/stopwatch.h"
#include "host/labeling/features/edge_context.h"
#include "host/learn/boosting/threshold_ranks.h"
#include "shaders/shared/context.h"

namespace exemplar {
namespace {

using Meshes = std::span<MeshFeatures* const>;
using shared::LinearParameters;
using shared::PredictionParameters;
using shared::RankedColumn;
using shared::RankParameters;
using shared::uvec4;
using shared::vec4;

static_assert(sizeof(RankedColumn) == sizeof(uvec4));  // the kernel fetches it as one

constexpr std::size_t k_place_unit = 16;  // rows; meshes begin at multiples, so that words of ranks belong to one mesh
constexpr std::size_t k_threshold_group = 4;

std::size_t rounded_up(std::size_t value, std::size_t unit) {
    return (value + unit - 1) / unit * unit;
}

// Returns the part of a linear classifier that reads the base features, or a constant alone.
LinearClassifier base_part(const LinearClassifier& classifier, std::size_t base) {
    LinearClassifier part = classifier;
    part.mean.resize(base);
    part.inverse.resize(base);
    part.weight.resize(base * classifier.class_count);
    return part;
}

// Returns the part that reads histograms as context_linear.comp has it: per column its mean and inverse deviation, then
// its weights, padded to groups of four classes.
std::vector<vec4> context_part(const LinearClassifier& classifier, std::size_t base) {
    const std::size_t classes = classifier.class_count, blocks = (classes + k_class_block - 1) / k_class_block;
    std::vector<vec4> table;
    table.reserve((classifier.feature_count() - base) * (1 + blocks));
    for (std::size_t f = base; f < classifier.feature_count(); ++f) {
        table.push_back({classifier.mean[f], classifier.inverse[f], 0, 0});
        for (std::size_t first = 0; first < classes; first += k_class_block) {
            const auto weight = [&](std::size_t c) {
                return first + c < classes ? classifier.weight[f * classes + first + c] : 0.0F;
            };
            table.push_back({weight(0), weight(1), weight(2), weight(3)});
        }
    }
    return table;
}

}  // namespace

struct GpuCascade::Columns {
    std::size_t base_count;                               // features before the contextual ones
    std::vector<FeatureThresholds> base;                  // of all stages
    std::vector<std::vector<FeatureThresholds>> context;  // of each stage, after the base in its place

    Columns(std::span<const CalibratedStumps> stages, std::size_t base_features) : base_count(base_features) {
        std::vector<std::vector<FeatureThresholds>> bases;
        for (const CalibratedStumps& stage : stages) {
            std::vector<FeatureThresholds> columns = thresholds_of(stage.stumps.stumps);
            const auto first = std::ranges::lower_bound(columns, base_count, {}, &FeatureThresholds::feature);
            context.emplace_back(std::make_move_iterator(first), std::make_move_iterator(columns.end()));
            columns.erase(first, columns.end());
            bases.push_back(std::move(columns));
        }
        base = merged(bases);
    }
    std::vector<FeatureThresholds> of_stage(std::size_t stage) const {
        std::vector<FeatureThresholds> all = base;
        all.insert(all.end(), context[stage].begin(), context[stage].end());
        return all;
    }
    std::size_t count() const {
        std::size_t most = 0;
        for (const std::vector<FeatureThresholds>& stage : context) most = std::max(most, stage.size());
        return base.size() + most;
    }
    bool fit_bytes() const {
        const auto fits = [](const FeatureThresholds& column) {
            return column.thresholds.size() <= k_max_ranked_thresholds;
        };
        return std::ranges::all_of(base, fits) &&
               std::ranges::all_of(context, [&](const auto& stage) { return std::ranges::all_of(stage, fits); });
    }
};

// All meshes share each buffer: the first row of each mesh, and the rows of all, multiples of k_stump_stride.
struct GpuCascade::Rows {
    std::vector<std::size_t> first_face, first_edge;
    std::size_t faces = 0, edges = 0;

    explicit Rows(Meshes meshes) {
        for (const MeshFeatures* mesh : meshes) {
            first_face.push_back(faces);
            first_edge.push_back(edges);
            faces += rounded_up(mesh->unary.rows, k_place_unit);
            edges += rounded_up(mesh->edges.size(), k_place_unit);
        }
        faces = rounded_up(faces, k_stump_stride);
        edges = rounded_up(edges, k_stump_stride);
    }
};

GpuCascade::GpuCascade(Device& device, GpuStumpScorer& scorer, Profiler* profiler, std::size_t tile_bytes)
    : device_(device),
      scorer_(scorer),
      tile_bytes_(buffer_limit(device.info(), tile_bytes)),
      stream_(device, profiler),
      context_(device),
      rows_per_thread_(device.choose(k_linear_rows)),
      linear_kernel_(device, shaders::labeling_context_linear_comp,
                     {.push_constants = layout_of<LinearParameters>(),
                      .elements = {layout_of<float>(), layout_of<float>(), layout_of<vec4>(), layout_of<float>()},
                      .constants = {{0, rows_per_thread_}}}),
      rank_kernel_(device, shaders::labeling_context_ranks_comp,
                   {.push_constants = layout_of<RankParameters>(),
                    .elements = {layout_of<vec4>(), layout_of<vec4>(), layout_of<uvec4>(), layout_of<vec4>(),
                                 layout_of<std::uint32_t>()}}) {}

std::size_t GpuCascade::fitting(const LabelingModel& model, Meshes meshes) const {
    const Columns of_faces(model.unary, model.unary_names.size()),
        of_edges(model.pairwise, model.pairwise_names.size());
    if (!of_faces.fit_bytes() || !of_edges.fit_bytes()) return 0;
    const std::size_t classes = model.class_count();
    ContextDemand context;
    std::size_t faces = 0, edges = 0, count = 0;
    for (const MeshFeatures* mesh : meshes) {
        const std::size_t samples = mesh->context.sample_face.size(), rows = rounded_up(mesh->unary.rows, k_place_unit);
        const ContextDemand more = demand_of(samples, rows, classes);
        context.bytes += more.bytes;
        context.texels += more.texels;
        faces += rows;
        edges += rounded_up(mesh->edges.size(), k_place_unit);
        const std::size_t all_faces = rounded_up(faces, k_stump_stride), all_edges = rounded_up(edges, k_stump_stride);
        const std::size_t histograms = k_context_axes * k_context_bins * classes * all_faces * sizeof(float);
        const std::size_t ranks = std::max(of_faces.count() * all_faces, of_edges.count() * all_edges);
        const std::size_t bytes = std::max({context.bytes, histograms, ranks, 2 * all_edges * sizeof(float),
                                            model.unary.size() * classes * all_faces * sizeof(float)});
        const std::size_t texels = std::max(context.texels, ranks / sizeof(std::uint32_t));
        if (samples == 0 || samples > k_max_iterations || rows == 0 || bytes > tile_bytes_ ||
            texels > device_.info().max_texels || count == k_max_context_works)
            break;
        ++count;
    }
    return count;
}

std::vector<FaceScores> GpuCascade::score(const LabelingModel& model, Meshes meshes) {
    for (const MeshFeatures* mesh : meshes) check_geometry(mesh->context);
    try {
        return score_checked(model, meshes);
    } catch (...) {  // as memory is used up, for example: fewer meshes may fit
        stream_.discard();
        for (Buffer* const buffer : {&face_ranks_, &edge_ranks_, &stumps_, &prediction_, &means_, &linear_, &boundary_})
            *buffer = {};
        context_.release();
        throw;
    }
}

std::vector<FaceScores> GpuCascade::score_checked(const LabelingModel& model, Meshes meshes) {
    const Stopwatch watch;
    const Columns of_faces(model.unary, model.unary_names.size()),
        of_edges(model.pairwise, model.pairwise_names.size());
    const Rows rows(meshes);
    const std::size_t classes = model.class_count();
    const bool has_edges = !model.pairwise.empty() && rows.edges > 0;
    record_unary(model, of_faces, rows, meshes);
    if (has_edges) {
        reserve(device_, boundary_, 2 * rows.edges * sizeof(float));
        upload_ranks(of_edges, rows, meshes, &MeshFeatures::pairwise, edge_ranks_);
        record_boundary(model, of_edges, 0, rows);
    }

    std::vector<FaceScores> scores(meshes.size());
    std::vector<std::vector<float>> of_both(meshes.size());  // the boundaries' two classes
    std::vector<BufferReadback> parts, edge_parts;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        scores[m].probabilities.resize(meshes[m]->unary.rows * classes);
        scores[m].boundary.assign(meshes[m]->edges.size(), k_unknown_boundary_probability);
        parts.push_back({&prediction_, rows.first_face[m] * classes * sizeof(float),
                         std::as_writable_bytes(std::span(scores[m].probabilities))});
        if (!has_edges || meshes[m]->edges.empty()) continue;
        of_both[m].resize(2 * meshes[m]->edges.size());
        edge_parts.push_back(
            {&boundary_, rows.first_edge[m] * 2 * sizeof(float), std::as_writable_bytes(std::span(of_both[m]))});
    }
    parts.insert(parts.end(), edge_parts.begin(), edge_parts.end());
    stream_.fetch(parts);
    const double first_seconds = watch.wall();
    add_seconds("unary", first_seconds, scores);

    const auto copy_boundaries = [&] {
        for (std::size_t m = 0; m < meshes.size(); ++m)
            if (!of_both[m].empty()) scores[m].boundary = boundary_column(of_both[m]);
    };
    if (has_edges) {
        copy_boundaries();
        for (std::size_t stage = 1; stage < model.pairwise.size(); ++stage) {
            check_interrupt();
            upload_edge_context(of_edges, stage, rows, meshes, scores);
            record_boundary(model, of_edges, stage, rows);
            stream_.fetch(edge_parts);
            copy_boundaries();
        }
    }
    add_seconds("pairwise", watch.wall() - first_seconds, scores);
    return scores;
}

// Records the upload of the base columns of all meshes, a column after the other, as ranks.
void GpuCascade::upload_ranks(const Columns& columns, const Rows& rows, Meshes meshes,
                              FeatureMatrix MeshFeatures::*matrix, Buffer& ranks) {
    const bool of_faces = matrix == &MeshFeatures::unary;
    const std::size_t stride = of_faces ? rows.faces : rows.edges;
    const std::vector<std::size_t>& first = of_faces ? rows.first_face : rows.first_edge;
    reserve(device_, ranks, std::max(columns.count(), std::size_t{1}) * stride);
    if (columns.base.empty()) return;
    stream_.upload_with(ranks, columns.base.size() * stride, 0, [&](std::span<std::byte> memory) {
        parallel_for(columns.base.size(), [&](std::size_t c) {
            for (std::size_t m = 0; m < meshes.size(); ++m)
                write_ranks((meshes[m]->*matrix).column(columns.base[c].feature), columns.base[c],
                            memory.subspan(c * stride + first[m]));
        });
    });
}

// Records the upload of what the histograms of all stages are made from.
void GpuCascade::upload_geometry(const Rows& rows, Meshes meshes, std::size_t classes) {
    std::vector<ContextWork> works;
    works.reserve(meshes.size());
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const ContextGeometry& geometry = meshes[m]->context;
        const std::size_t first = rows.first_face[m];
        ContextWork work{
            &geometry, {0, geometry.sample_face.size()}, {0, geometry.faces}, {0, classes}, {}, first, first,
            rows.faces};
        for (const std::uint32_t face : geometry.sample_face)
            work.rows.push_back(static_cast<std::uint32_t>(first + face));
        works.push_back(std::move(work));
    }
    context_.upload(stream_, works, k_geodesic_columns * classes * rows.faces);
}

// Records the upload of the scores of a stage's linear classifier for the base features, which the host computes: the
// device has only their ranks.
void GpuCascade::upload_linear(const LabelingModel& model, std::size_t stage, const Rows& rows, Meshes meshes) {
    const LinearClassifier base = base_part(model.linear[stage].classifier, model.unary_names.size());
    const std::size_t classes = model.class_count(), bytes = rows.faces * classes * sizeof(float);
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        std::vector<float> scores(meshes[m]->unary.rows * classes);
        linear_scores(base, meshes[m]->unary, scores);
        stream_.upload<float>(linear_, scores, stage * bytes + rows.first_face[m] * classes * sizeof(float));
    }
}

// Records all stages of the faces, up to the prediction.
void GpuCascade::record_unary(const LabelingModel& model, const Columns& columns, const Rows& rows, Meshes meshes) {
    const std::size_t classes = model.class_count(), stages = model.unary.size();
    const std::size_t bytes = rows.faces * classes * sizeof(float);
    reserve(device_, stumps_, bytes);
    reserve(device_, prediction_, bytes);
    reserve(device_, means_, model.averaged_labels.empty() ? sizeof(float) : bytes);
    reserve(device_, linear_, stages * bytes);
    upload_ranks(columns, rows, meshes, &MeshFeatures::unary, face_ranks_);
    for (std::size_t stage = 0; stage < model.linear.size(); ++stage)
        if (model.linear[stage].used()) upload_linear(model, stage, rows, meshes);
    if (stages > 1) upload_geometry(rows, meshes, classes);
    for (std::size_t stage = 0; stage < stages; ++stage) {
        if (stage > 0) {
            context_.record(stream_, prediction_, classes);
            record_context_ranks(columns, stage, rows, classes);
        }
        const CalibratedStumps& stumps = model.unary[stage];
        scorer_.record_ranks(stream_, stumps.stumps, stumps.link, stumps.scale, columns.of_stage(stage), face_ranks_,
                             rows.faces, rows.faces, stumps_);
        record_prediction(model, stage, rows);
    }
}

// Records the ranks of a stage's contextual columns, from the histograms to their place after the base columns.
void GpuCascade::record_context_ranks(const Columns& columns, std::size_t stage, const Rows& rows,
                                      std::size_t classes) {
    const std::vector<FeatureThresholds>& context = columns.context[stage];
    if (context.empty()) return;
    std::vector<RankedColumn> table;
    std::vector<float> thresholds;
    for (std::size_t i = 0; i < context.size(); ++i) {
        const auto first = static_cast<std::uint32_t>(thresholds.size() / k_threshold_group);
        thresholds.insert(thresholds.end(), context[i].thresholds.begin(), context[i].thresholds.end());
        thresholds.resize(rounded_up(thresholds.size(), k_threshold_group), std::numeric_limits<float>::max());
        table.push_back({static_cast<std::uint32_t>(context[i].feature - columns.base_count),
                         static_cast<std::uint32_t>(columns.base.size() + i), first,
                         static_cast<std::uint32_t>(thresholds.size() / k_threshold_group) - first});
    }
    const Buffer column_table = uploaded<RankedColumn>(device_, stream_, table),
                 threshold_table = uploaded<float>(device_, stream_, thresholds);
    stream_.dispatch(rank_kernel_, Threads(rows.faces / 4, context.size()),
                     {context_.geodesic(), context_.axes(), column_table, threshold_table, face_ranks_},
                     RankParameters{static_cast<std::uint32_t>(rows.faces),
                                    static_cast<std::uint32_t>(k_geodesic_columns * classes)});
}

// Records the addition of the scores of a stage's linear classifier for the histograms.
void GpuCascade::record_linear(const LinearClassifier& classifier, std::size_t base, const Rows& rows,
                               const BufferRange& scores) {
    const std::vector<vec4> weights = context_part(classifier, base);
    if (weights.empty()) return;
    const Buffer table = uploaded<vec4>(device_, stream_, weights);
    const std::size_t threads = (rows.faces + rows_per_thread_ - 1) / rows_per_thread_,
                      blocks = (classifier.class_count + k_class_block - 1) / k_class_block;
    stream_.dispatch(linear_kernel_, Threads(threads, blocks), {context_.geodesic(), context_.axes(), table, scores},
                     LinearParameters{static_cast<std::uint32_t>(rows.faces), classifier.class_count,
                                      static_cast<std::uint32_t>(threads)});
}

const Kernel& GpuCascade::prediction_kernel(std::uint32_t classes) {
    Kernel& kernel = prediction_kernels_[classes];
    if (!kernel)
        kernel = Kernel(device_, shaders::labeling_prediction_comp,
                        {.push_constants = layout_of<PredictionParameters>(),
                         .elements = {layout_of<float>(), layout_of<float>(), layout_of<float>(), layout_of<float>()},
                         .constants = {{0, classes}}});
    return kernel;
}

// Records the combination of a stage's stumps with its linear classifier and with the stages before.
void GpuCascade::record_prediction(const LabelingModel& model, std::size_t stage, const Rows& rows) {
    const std::size_t classes = model.class_count(), bytes = rows.faces * classes * sizeof(float);
    const BufferRange linear(linear_, stage * bytes, bytes);
    PredictionParameters parameters{.rows = static_cast<std::uint32_t>(rows.faces),
                                    .combines = 0,
                                    .ratio = 0,
                                    .scale = 1,
                                    .stages = static_cast<float>(stage + 1),
                                    .averaged_low = 0,
                                    .averaged_high = 0};
    for (const std::uint32_t c : model.averaged_labels)
        (c < 32 ? parameters.averaged_low : parameters.averaged_high) |= 1U << (c % 32);
    if (stage < model.linear.size() && model.linear[stage].used()) {
        const LinearExpert& expert = model.linear[stage];
        parameters.combines = 1;
        parameters.ratio = expert.ratio;
        parameters.scale = expert.scale;
        record_linear(expert.classifier, model.unary_names.size(), rows, linear);
    }
    stream_.dispatch(prediction_kernel(static_cast<std::uint32_t>(classes)), rows.faces,
                     {stumps_, linear, means_, prediction_}, parameters);
}

void GpuCascade::record_boundary(const LabelingModel& model, const Columns& columns, std::size_t stage,
                                 const Rows& rows) {
    const CalibratedStumps& stumps = model.pairwise[stage];
    scorer_.record_ranks(stream_, stumps.stumps, stumps.link, stumps.scale, columns.of_stage(stage), edge_ranks_,
                         rows.edges, rows.edges, boundary_);
}

// Records the upload of the contextual columns of a stage of the edges.
void GpuCascade::upload_edge_context(const Columns& columns, std::size_t stage, const Rows& rows, Meshes meshes,
                                     std::span<const FaceScores> scores) {
    const std::vector<FeatureThresholds>& context = columns.context[stage];
    if (context.empty()) return;
    std::vector<std::vector<float>> sums(meshes.size());  // bins x edges
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        sums[m].resize(EdgeNeighborhood::k_bins * meshes[m]->edges.size());
        accumulate_edge_context(*meshes[m], scores[m].boundary, sums[m]);
    }
    stream_.upload_with(edge_ranks_, context.size() * rows.edges, columns.base.size() * rows.edges,
                        [&](std::span<std::byte> memory) {
                            for (std::size_t c = 0; c < context.size(); ++c)
                                for (std::size_t m = 0; m < meshes.size(); ++m) {
                                    const std::size_t edges = meshes[m]->edges.size();
                                    const std::size_t bin = context[c].feature - columns.base_count;
                                    write_ranks(std::span(sums[m]).subspan(bin * edges, edges), context[c],
                                                memory.subspan(c * rows.edges + rows.first_edge[m]));
                                }
                        });
}

}  // namespace exemplar
