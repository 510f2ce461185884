// The rows of `exemplar bench` on whole meshes: features, training, labeling.

#include <fmt/format.h>

#include <algorithm>

#include "apps/exemplar/bench/bench_data.h"
#include "apps/exemplar/bench/bench_rows.h"
#include "host/core/progress.h"
#include "host/labeling/features/fast_context.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/labeling/training/training.h"

namespace exemplar {
namespace {

constexpr std::size_t k_faces = 20'000, k_bench_training_meshes = 6;
constexpr std::size_t k_quick_rows = 1500;  // faces per mesh of a model that serves only to be applied

/// The CPU implementations that replace shaders where the device is a CPU; they obey the thread limit.
struct HostBackend {
    CpuStumpScorer scorer;
    FastContextHistograms context;
    LabelingBackend labeling() { return {scorer, context}; }
};

std::vector<MeshFeatures> all_features(const LabeledCorpus& corpus) {
    Progress progress("computing features", corpus.meshes.size());
    std::vector<MeshFeatures> features;
    for (const LabeledMesh& mesh : corpus.meshes) {
        features.push_back(compute_features(mesh.mesh));
        progress.advance(1, mesh.name);
    }
    return features;
}

LabelingModel train(const LabeledCorpus& corpus, std::size_t rows_per_mesh, const LabelingBackend& backend) {
    std::vector<MeshFeatures> features = all_features(corpus);
    TrainOptions options;
    options.rows_per_mesh = rows_per_mesh;
    TrainReport report;
    return train_labeling(corpus, features, options, backend, report);
}

std::size_t stump_count(const LabelingModel& model) {
    std::size_t count = 0;
    for (const auto* cascade : {&model.unary, &model.pairwise})
        for (const CalibratedStumps& stage : *cascade) count += stage.stumps.stumps.size();
    return count;
}

/// A folder for this run's cache, gone with it.
struct TemporaryFolder {
    std::filesystem::path path;
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "exemplar-bench-XXXXXX").string();
        if (mkdtemp(name.data())) path = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        if (!path.empty()) std::filesystem::remove_all(path, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

}  // namespace

DeviceBackend& BenchContext::backend() {
    if (!backend_) backend_ = std::make_unique<DeviceBackend>(options_.device);
    return *backend_;
}

const LabeledCorpus& BenchContext::corpus() {
    if (!corpus_)
        corpus_ = options_.meshes.empty() ? generated_fourlegs(k_bench_training_meshes, k_faces)
                                          : working_corpus(load_corpus(list_meshes(options_.meshes)));
    return *corpus_;
}

const LabeledMesh& BenchContext::mesh() {
    const auto distance = [](const LabeledMesh& mesh) {
        return std::max(mesh.mesh.face_count(), k_faces) - std::min(mesh.mesh.face_count(), k_faces);
    };
    return *std::ranges::min_element(corpus().meshes, {}, distance);
}

const LabelingModel& BenchContext::model() {
    if (!model_) model_ = train(corpus(), k_quick_rows, backend().labeling());
    return *model_;
}

void bench_features(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    const LabeledMesh& mesh = context.mesh();
    BenchRow result{.name = "features",
                    .what = fmt::format("all of {}, {} faces", mesh.name, mesh.mesh.face_count()),
                    .goal = "5 s, under 1 GiB",
                    .others = "thesis 15 min; the authors' program about 150 s CPU; CGAL's shape diameter alone 1.9 s"};
    MeshFeatures features;
    const auto run = [&] { features = compute_features(mesh.mesh); };
    result.cost = measure(context.runs(), run);
    std::string families;
    for (const auto& [family, seconds] : features.seconds) {
        families += fmt::format("{}{} {:.2f}", families.empty() ? "" : ", ", family, seconds);
        result.numbers["seconds_per_family"][family] = seconds;
    }
    result.remarks.push_back(fmt::format("seconds per family: {}", families));
    if (!context.quick()) result.single_thread = measure_single_thread(1, run);
    row(result);
}

void bench_training(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    const LabeledCorpus& corpus = context.corpus();
    std::size_t faces = 0;
    for (const LabeledMesh& mesh : corpus.meshes) faces += mesh.mesh.face_count();
    BenchRow result{.name = "train",
                    .what = fmt::format("on {} meshes, {} faces, features included", corpus.meshes.size(), faces),
                    .goal = "8 min",
                    .others = "thesis 8 h"};
    result.cost = measure(1, [&] { context.set_model(train(corpus, 0, context.backend().labeling())); });
    result.remarks.push_back(fmt::format("{} labels, {} stumps", corpus.names.size(), stump_count(context.model())));
    if (!context.quick()) {
        HostBackend host;
        result.single_thread = measure_single_thread(1, [&] { train(corpus, 0, host.labeling()); });
    }
    row(result);
}

void bench_labeling(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    const LabeledMesh& mesh = context.mesh();
    const LabelingModel& model = context.model();
    const TemporaryFolder cache;
    HostBackend host;
    const auto label = [&](const std::filesystem::path& folder, const LabelingBackend& backend) {
        label_mesh(model, mesh.mesh, folder, backend);
    };
    label(cache.path, context.backend().labeling());  // fills the cache and compiles the kernels

    const auto measure_with = [&](const std::filesystem::path& folder, BenchRow result) {
        result.name = "label";
        result.cost = measure(context.runs(), [&] { label(folder, context.backend().labeling()); });
        result.remarks.push_back(fmt::format("{} stumps of {} labels, scored on {}", stump_count(model),
                                             model.class_count(), context.backend().labeling_device_name()));
        if (!context.quick()) result.single_thread = measure_single_thread(1, [&] { label(folder, host.labeling()); });
        row(result);
    };
    const std::string what = fmt::format("{}, {} faces", mesh.name, mesh.mesh.face_count());
    measure_with({}, {.what = what + ", features included", .goal = "8 s"});
    measure_with(cache.path,
                 {.what = what + ", features cached", .goal = "0.5 s", .others = "the authors' program 43 s"});
}

}  // namespace exemplar
