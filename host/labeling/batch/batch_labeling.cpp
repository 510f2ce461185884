#include "host/labeling/batch/batch_labeling.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

#include "host/core/device_memory_error.h"
#include "host/core/errors.h"
#include "host/core/freed_memory.h"
#include "host/core/stopwatch.h"
#include "host/data/catalog/catalog_run.h"
#include "host/data/catalog/shape_scan.h"
#include "host/labeling/features/feature_cache.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

using Item = std::unique_ptr<BatchShape>;

/// Memory estimates, in bytes. Per face of the working mesh, while its features are computed:
constexpr std::size_t k_bytes_per_face = 28'000;
/// Per face and sample beyond the usual number: a distance and its bin.
constexpr std::size_t k_usual_samples = 1000, k_bytes_per_sample = 5;
/// Per face of the original mesh, while it is simplified.
constexpr std::size_t k_bytes_per_original_face = 160;
/// Per shape, at least.
constexpr std::size_t k_bytes_per_shape = 4 << 20;

/// Returns how much of `memory` the shapes may take. The process has taken the rest already, for models and libraries.
std::size_t memory_for_shapes(std::size_t memory) {
    return memory - std::min(memory, resident_memory());
}

std::size_t bytes_of(const MeshFeatures& features) {
    return (features.unary.values.capacity() + features.pairwise.values.capacity()) * sizeof(float) +
           features.context.geodesic_bin.capacity() + features.edge_context.edge.capacity() * 5;
}

class Batch {
  public:
    Batch(const BatchModels& models, const LabelingBackend& backend, const BatchOptions& options)
        : models_(models),
          backend_(backend),
          options_(options),
          max_memory_(options.memory),
          budget_(memory_for_shapes(max_memory_)),
          threads_(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)),
          arena_(static_cast<int>(threads_)) {}

    std::vector<StageStatistics> run(const std::function<std::optional<CatalogShape>()>& next,
                                     const std::function<void(BatchShape&)>& write) {
        const std::size_t group = std::max<std::size_t>(options_.group, 1), cuts = (threads_ + 1) / 2;
        Pipeline<Item> pipeline(
            [&] { return begin(next()); },
            {{"read", 1, 1, 2, each([this](BatchShape& item) { read(item); })},
             {"features", threads_, 1, 2, each([this](BatchShape& item) { compute_features_of(item); })},
             {"scores", 1, group, group, [this](std::span<Item> items) { score(items); }},
             {"cuts", cuts, 1, group, each([this](BatchShape& item) { cut(item); })},
             {"writing", 1, 1, 2, [&](std::span<Item> items) { finish(*items.front(), write); }}});
        pipeline.run([this] { budget_.abandon(); });
        return pipeline.reports();
    }

  private:
    /// Waits until there is memory for the shape.
    std::optional<Item> begin(std::optional<CatalogShape> shape) {
        if (!shape) return {};
        auto item = std::make_unique<BatchShape>();
        item->shape = std::move(*shape);
        // A polygon becomes several faces, about two for each vertex.
        const std::int64_t most = std::max(item->shape.faces, 2 * item->shape.vertices);
        const auto faces = static_cast<std::size_t>(std::max<std::int64_t>(most, 0));
        const auto bytes = static_cast<std::uint64_t>(std::max<std::int64_t>(item->shape.bytes, 0));
        take_memory(*item, faces, bytes);
        const std::uint64_t now = bytes_now(item->shape.path);
        if (now > bytes) take_memory(*item, faces, now);
        return item;
    }
    void take_memory(BatchShape& item, std::size_t faces, std::uint64_t bytes) {
        item.memory = {};  // a waiting shape must hold no memory
        item.memory = budget_.take(std::min(memory_for(faces, bytes), max_memory_));
    }
    /// Returns how many bytes there are to read now: more than cataloged if the file has grown or refers to other
    /// files. Returns 0 on an error, which reading will report.
    std::uint64_t bytes_now(const std::filesystem::path& path) const {
        try {
            return bytes_to_read(path, max_memory_);
        } catch (const Error&) {
            return 0;
        }
    }
    std::size_t memory_for(std::size_t faces, std::uint64_t file_bytes) const {
        const std::size_t working = std::min<std::size_t>(faces, k_max_working_faces);
        const std::size_t samples = std::max(std::min(models_.features.samples, working), k_usual_samples);
        return k_bytes_per_shape + (k_bytes_per_face + k_bytes_per_sample * (samples - k_usual_samples)) * working +
               k_bytes_per_original_face * faces + reading_memory(file_bytes);
    }
    /// Most memory that scoring adds: per label the probabilities of two stages, and the contextual columns (not on a
    /// card).
    static std::size_t memory_of_scores(const BatchShape& item) {
        if (!item.model) return 0;
        const std::size_t columns = k_context_measures * k_context_bins + 2;
        return sizeof(float) * columns * item.model->model.class_count() * item.prepared.features.unary.rows;
    }

    /// Makes a stage that processes one shape at a time and skips those with an error.
    template <typename Work>
    std::function<void(std::span<Item>)> each(Work work) {
        return [this, work](std::span<Item> items) {
            for (Item& item : items) attempt(*item, [&] { work(*item); });
        };
    }
    /// Runs `work` on a shape; an error that concerns this shape alone is stored in its record.
    template <typename Work>
    void attempt(BatchShape& item, Work&& work) {
        if (!item.record.error.empty()) return;
        try {
            work();
        } catch (const MeshError& error) {
            item.record.error = error.what();
        } catch (const UsageError& error) {  // extreme meshes can lead to values out of range
            item.record.error = fmt::format("{}: {}", item.shape.path.string(), error.what());
        } catch (const std::bad_alloc&) {
            item.record.error = item.shape.path.string() + ": there is not enough memory for it";
        }
    }

    void read(BatchShape& item) {
        const Stopwatch watch;
        CatalogShape& shape = item.shape;
        std::string hash;
        try {
            const std::uint64_t bytes = bytes_to_read(shape.path, max_memory_);
            hash = file_hash(shape.path);
            item.memory.resize(memory_for(static_cast<std::size_t>(std::max<std::int64_t>(shape.faces, 0)), bytes));
        } catch (const DataError& error) {  // the file has vanished
            throw MeshError(error.what());
        }
        if (hash != shape.hash) look_again(item);
        item.record.content = content_of(shape);
        if (!shape.problem.empty()) throw MeshError(shape.problem);
        item.file = read_mesh(shape.path);
        item.memory.resize(memory_for(item.file.mesh.face_count(), 0));
        item.record.seconds["read"] = watch.wall();
    }
    /// Describes the shape anew, as its file has changed since it was cataloged.
    void look_again(BatchShape& item) {
        CatalogShape now = describe_shape(item.shape.path, max_memory_);
        now.id = item.shape.id;
        now.name = item.shape.name;
        now.category = item.shape.category;
        item.shape = std::move(now);
        item.changed = true;
    }

    void compute_features_of(BatchShape& item) {
        const Stopwatch watch;
        arena_.execute([&] { item.prepared = working_features(models_.features, item.file.mesh, options_.cache); });
        item.record.features = item.prepared.cache_entry;
        choose_model(item);
        item.memory.resize(k_bytes_per_shape + bytes_of(item.prepared.features) + memory_of_scores(item) +
                           100 * item.file.mesh.face_count());
        // The C library would keep what was freed, beside what the next shape takes.
        if (memory_for(item.file.mesh.face_count(), 0) > max_memory_ / 16) give_back_freed_memory();
        item.record.seconds["features"] = watch.wall();
    }
    /// Chooses the model by the category that the user gave, otherwise by the recognized one.
    void choose_model(BatchShape& item) {
        const std::string& given = item.shape.category;
        item.record.category = given;
        if (models_.is_single_model) {
            item.model = &models_.models.front();
        } else if (!given.empty()) {
            item.model = models_.of_category(given);
            if (!item.model) item.record.error = fmt::format("there is no model of the category '{}'", given);
        } else if (models_.recognizer) {
            recognize_model(item);
        } else {
            item.record.error =
                "its category is not known, and no model recognizes categories (make one with 'exemplar category "
                "train', or add the shape with --category)";
        }
    }
    void recognize_model(BatchShape& item) {
        const CategoryPrediction prediction = recognize(*models_.recognizer, item.prepared.features);
        const auto most = std::ranges::max_element(prediction.probability);
        const std::string& likely =
            models_.recognizer->category_names[static_cast<std::size_t>(most - prediction.probability.begin())];
        item.record.category_probability = prediction.confidence;
        item.record.category = prediction.category < 0 ? k_unknown_category : likely;
        if (prediction.category < 0) {
            item.record.error =
                fmt::format("of no category that is known; most like '{}' ({:.2f})", likely, prediction.confidence);
            return;
        }
        item.model = models_.of_category(likely);
        if (!item.model) item.record.error = fmt::format("there is no model of the category '{}'", likely);
    }

    /// Scores the shapes, those of the same model together.
    void score(std::span<Item> items) {
        std::ranges::stable_sort(items, {}, [](const Item& item) { return item->model; });
        for (std::size_t first = 0; first < items.size();) {
            std::size_t end = first + 1;
            while (end < items.size() && items[end]->model == items[first]->model) ++end;
            score_alike(items.subspan(first, end - first));
            first = end;
        }
    }
    void score_alike(std::span<Item> items) {
        std::vector<BatchShape*> good;
        std::vector<MeshFeatures*> features;
        for (const Item& item : items) {
            if (!item->record.error.empty()) continue;
            good.push_back(item.get());
            features.push_back(&item->prepared.features);
        }
        if (good.empty()) return;
        const Stopwatch watch;
        try {
            std::vector<FaceScores> scores = score_faces(good.front()->model->model, features, backend_);
            for (std::size_t i = 0; i < good.size(); ++i) {
                good[i]->scores = std::move(scores[i]);
                good[i]->record.seconds["scores"] = watch.wall() / static_cast<double>(good.size());
            }
        } catch (const std::bad_alloc&) {
            score_fewer(items, good);
        } catch (const DeviceMemoryError&) {
            score_fewer(items, good);
        }
    }
    /// Scores the shapes one by one, as memory did not suffice for all of them together.
    void score_fewer(std::span<Item> items, const std::vector<BatchShape*>& good) {
        if (good.size() == 1) good.front()->record.error = "there is not enough memory to score it";
        if (good.size() > 1)
            for (Item& item : items) score_alike(std::span(&item, 1));
    }

    void cut(BatchShape& item) {
        const Stopwatch watch;
        item.labeling = finish_labeling(item.model->model, item.prepared, std::move(item.scores));
        item.prepared = {};
        item.memory.resize(k_bytes_per_shape + 200 * item.file.mesh.face_count());
        item.record.model = item.model->name;
        item.record.model_hash = item.model->hash;
        item.record.seconds["cut"] = watch.wall();
    }

    static void finish(BatchShape& item, const std::function<void(BatchShape&)>& write) {
        if (item.record.content.empty()) item.record.content = content_of(item.shape);
        write(item);
    }

    const BatchModels& models_;
    const LabelingBackend& backend_;
    const BatchOptions& options_;
    std::size_t max_memory_;
    MemoryBudget budget_;
    std::size_t threads_;
    tbb::task_arena arena_;
};

}  // namespace

std::vector<StageStatistics> label_batch(const std::function<std::optional<CatalogShape>()>& next,
                                         const std::function<void(BatchShape&)>& write, const BatchModels& models,
                                         const LabelingBackend& backend, const BatchOptions& options) {
    return Batch(models, backend, options).run(next, write);
}

}  // namespace exemplar
