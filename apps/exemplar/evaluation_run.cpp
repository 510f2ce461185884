#include "apps/exemplar/evaluation_run.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/exemplar/commands.h"
#include "apps/exemplar/labeled_output.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/labeling/report_page.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t k_shown_meshes = 6;  ///< of each category in the page
constexpr const char* k_rates[] = {"recognition_rate", "segment_weighted_accuracy", "rand_error"};

/// The content of a mesh file and of the labels beside it, as 16 hexadecimal digits.
std::string digest(const fs::path& mesh) {
    const fs::path labels = mesh.parent_path() / (mesh.stem().string() + "_labels.txt");
    const std::string content = read_file(mesh) + (fs::exists(labels) ? read_file(labels) : std::string());
    return fmt::format("{:016x}", XXH3_64bits(content.data(), content.size()));
}

/// Everything that a model depends on: results of another run are not mixed into this one.
std::string run_key(const EvaluationTask& task, const TrainOptions& train) {
    Json key{{"seed", train.seed},
             {"rounds", train.rounds},
             {"patience", train.patience},
             {"stages", train.max_stages},
             {"bins", train.bins},
             {"rows", train.rows_per_mesh},
             {"feature_fraction", train.feature_fraction},
             {"shrinkage", train.shrinkage},
             {"samples", train.features.samples},
             {"orientation", train.features.orientation},
             {"features", k_feature_version},
             {"format", k_model_format_version}};
    for (const fs::path& path : task.train) key["train"].push_back({path.stem().string(), digest(path)});
    return key.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The JSON of a file; null if it is missing or damaged.
Json read_json(const fs::path& path) {
    if (!fs::exists(path)) return nullptr;
    Json json = Json::parse(read_file(path), nullptr, false);
    return json.is_object() ? json : Json(nullptr);
}

Json rate_json(double rate) {
    return std::isnan(rate) ? Json(nullptr) : Json(rate);
}

/// Mean of each rate over `items`, without those that lack it.
Json mean_rates(const Json& items) {
    Json means = Json::object();
    for (const char* rate : k_rates) {
        double sum = 0;
        int count = 0;
        for (const Json& item : items)
            if (const double value = rate_of(item, rate); !std::isnan(value)) sum += value, ++count;
        means[rate] = rate_json(count ? sum / count : std::numeric_limits<double>::quiet_NaN());
    }
    return means;
}

fs::path folder_of(const fs::path& out, const EvaluationTask& task) {
    return out / task.category / task.split;
}

/// Human segmentations are per face of the file; here they are wanted per triangle.
std::vector<std::vector<std::int32_t>> human_segmentations(const fs::path& folder, const LabeledMesh& item) {
    auto segmentations = read_human_segmentations(folder, item.name, item.mesh.source_face_count);
    for (std::vector<std::int32_t>& segments : segmentations) {
        std::vector<std::int32_t> of_triangle;
        for (std::uint32_t f = 0; f < item.mesh.face_count(); ++f)
            of_triangle.push_back(segments[item.mesh.source_of(f)]);
        segments = std::move(of_triangle);
    }
    return segmentations;
}

/// Confusion summed over meshes and divided by their number.
std::vector<double> mean_confusion(const Json& meshes) {
    std::vector<double> sum;
    for (const Json& mesh : meshes) {
        const auto confusion = mesh.at("confusion").get<std::vector<double>>();
        sum.resize(confusion.size(), 0);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += confusion[i] / static_cast<double>(meshes.size());
    }
    return sum;
}

}  // namespace

double rate_of(const Json& json, const char* key) {
    return json.contains(key) && json[key].is_number() ? json[key].get<double>()
                                                       : std::numeric_limits<double>::quiet_NaN();
}

/// The JSON of an earlier run if it was about the same; else null.
Json EvaluationRun::finished(const fs::path& path, const std::string& key) const {
    if (behavior_.fresh) return nullptr;
    Json done = read_json(path);
    return done.is_object() && done.contains("key") && done["key"] == key ? done : Json(nullptr);
}

void EvaluationRun::warn(const std::vector<std::string>& warnings) const {
    if (behavior_.quiet) return;
    for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", warning);
}

LabelingModel EvaluationRun::model_for(const EvaluationTask& task, const fs::path& folder, const std::string& key) {
    const fs::path path = folder / "model.safetensors", run = folder / "run.json";
    if (!finished(run, key).is_null() && fs::exists(path)) {
        try {
            return load_model(path);
        } catch (const ModelError&) {
            // Damaged: trained again below.
        }
    }
    const Stopwatch watch;
    const LabeledCorpus corpus = load_corpus(task.train);
    warn(corpus.warnings);
    std::vector<MeshFeatures> features = features_of(corpus, train_.features, cache_);
    const double feature_seconds = watch.wall();
    TrainReport report;
    LabelingModel model = train_labeling(corpus, features, train_, backend_.labeling(), report);
    if (!behavior_.quiet) print_training(model, report);
    save_model(path, model);
    Json json = describe_training(model, report);
    json["key"] = key;
    json["seconds"] = {{"features", feature_seconds}, {"all", watch.wall()}, {"cpu", watch.cpu()}};
    write_json(run, json);
    return model;
}

Json EvaluationRun::test_mesh(const EvaluationTask& task, const fs::path& mesh, const fs::path& folder,
                              const LabelingModel& model, const std::string& key) {
    const fs::path stem = folder / mesh.stem(), scores = stem.string() + ".json";
    const std::string mesh_key = fmt::format("{} {} {}", key, digest(mesh), task.humans.string());
    if (Json done = finished(scores, mesh_key); !done.is_null()) {
        done["path"] = mesh.string();  // the same mesh may have moved
        return done;
    }
    const Stopwatch watch;
    // A test mesh may have labels that the training meshes lack; they can only be wrong, but they count.
    const LabeledCorpus own = load_corpus({mesh});
    warn(own.warnings);
    std::vector<std::string> names = model.label_names;
    for (const std::string& name : own.names) {
        if (std::find(model.label_names.begin(), model.label_names.end(), name) != model.label_names.end()) continue;
        warn({fmt::format("{}: no training mesh has the label '{}'{}: its faces will count as wrong", mesh.string(),
                          name, suggestion(name, model.label_names))});
        names.push_back(name);
    }
    const LabeledCorpus corpus = load_corpus({mesh}, names);
    const LabeledMesh& item = corpus.meshes.front();

    MeshFeatures features = cached_features(item.mesh, model.feature_options, cache_);
    const double feature_seconds = watch.wall();
    const FaceLabeling labeling = label_faces(model, features, backend_.labeling());
    const LabeledOutput output = make_labeled_output(item.mesh, model, labeling);
    write_labels_txt(stem.string() + "_labels.txt", output.labels);
    write_ply(stem.string() + ".ply", item.mesh, &output.labels, output.confidence);
    const MeshScore score =
        score_labeling(features, item.label, labeling.label, names.size(), human_segmentations(task.humans, item));
    Json json{{"key", mesh_key},
              {"mesh", item.name},
              {"path", mesh.string()},
              {"names", names},
              {"recognition_rate", rate_json(score.recognition_rate)},
              {"segment_weighted_accuracy", rate_json(score.segment_weighted_accuracy)},
              {"rand_error", rate_json(score.rand_error)},
              {"confusion", score.confusion},
              {"seconds", {{"features", feature_seconds}, {"all", watch.wall()}}}};
    write_json(scores, json);
    return json;
}

Json EvaluationRun::run_task(const EvaluationTask& task, Progress& progress) {
    const fs::path folder = folder_of(out_, task);
    const std::string key = run_key(task, train_);
    const LabelingModel model = model_for(task, folder, key);
    progress.advance(1, task.category + " trained");
    Json result{{"split", task.split}, {"train", Json::array()}, {"meshes", Json::array()}};
    for (const fs::path& path : task.train) result["train"].push_back(path.stem().string());
    for (const fs::path& mesh : task.test) {
        check_interrupt();
        result["meshes"].push_back(test_mesh(task, mesh, folder, model, key));
        result["meshes"].back().erase("key");
        progress.advance(1, task.category + "/" + mesh.stem().string());
    }
    return result;
}

Json EvaluationRun::evaluate(const std::vector<EvaluationTask>& tasks, const std::string& protocol,
                             const std::string& title) {
    std::size_t steps = 0;
    for (const EvaluationTask& task : tasks) steps += 1 + task.test.size();
    Progress progress("evaluating", steps);
    Json report{{"protocol", protocol}, {"device", backend_.device_name()}, {"categories", Json::array()}};
    for (const EvaluationTask& task : tasks) {
        Json split = run_task(task, progress);
        Json& categories = report["categories"];
        if (categories.empty() || categories.back()["category"] != task.category)
            categories.push_back({{"category", task.category}, {"splits", Json::array()}, {"meshes", 0}});
        Json& category = categories.back();
        category["meshes"] = category["meshes"].get<std::size_t>() + split["meshes"].size();
        category["splits"].push_back(std::move(split));
        Json all = Json::array();
        for (const Json& done : category["splits"])
            for (const Json& mesh : done["meshes"]) all.push_back(mesh);
        category.update(mean_rates(all));
    }
    progress.finish();
    report.update(mean_rates(report["categories"]));
    write_page(tasks, report, title);
    return report;
}

ReportData EvaluationRun::report_group(const EvaluationTask& task, const Json& category, const LabeledCorpus& shown) {
    const fs::path folder = folder_of(out_, task);
    const LabelingModel model = load_model(folder / "model.safetensors");
    const Json run = read_json(folder / "run.json");
    const Json& meshes = category["splits"][0]["meshes"];
    ReportData group;
    group.title = category["category"];
    group.subtitle =
        fmt::format("{} training meshes, {} unseen meshes", category["splits"][0]["train"].size(), meshes.size());
    if (const std::size_t splits = category["splits"].size(); splits > 1)
        group.subtitle += fmt::format("; {} splits, of which the first is shown and the rates are the mean", splits);
    group.recognition_rate = rate_of(category, "recognition_rate");
    group.label_names = shown.names;
    for (std::size_t c = 0; c < shown.names.size(); ++c) group.label_colors.push_back(label_color(c));
    for (std::size_t i = 0; i < shown.meshes.size(); ++i) {
        const LabeledMesh& mesh = shown.meshes[i];
        MeshFeatures features = cached_features(mesh.mesh, model.feature_options, cache_);
        FaceLabeling labeling = label_faces(model, features, backend_.labeling());
        group.meshes.push_back({mesh.name, &mesh.mesh, std::move(labeling.label), mesh.label,
                                std::move(labeling.confidence), rate_of(meshes[i], "recognition_rate")});
    }
    const auto same_names = [&](const Json& mesh) { return mesh["names"].size() == model.class_count(); };
    if (std::all_of(meshes.begin(), meshes.end(), same_names)) group.confusion = mean_confusion(meshes);
    group.feature_families = stumps_per_family(model);
    group.first_features = first_features(model, 10);
    double label_seconds = 0;
    for (const Json& mesh : meshes)
        label_seconds += (mesh["seconds"]["all"].get<double>() - mesh["seconds"]["features"].get<double>()) /
                         static_cast<double>(meshes.size());
    group.timings = {{"features of the training meshes", run["seconds"]["features"]},
                     {"training, all", run["seconds"]["all"]},
                     {"labeling a mesh, features ready (mean)", label_seconds}};
    const auto show = [&](const char* key, const char* title) {
        if (const double rate = rate_of(category, key); !std::isnan(rate))
            group.summary.emplace_back(title, fmt::format("{:.1f} %", 100 * rate));
    };
    show("recognition_rate", "recognition rate");
    show("segment_weighted_accuracy", "segment-weighted accuracy");
    show("rand_error", "Rand index error");
    return group;
}

void EvaluationRun::write_page(const std::vector<EvaluationTask>& tasks, const Json& report, const std::string& title) {
    std::vector<LabeledCorpus> shown;  // the page refers to the meshes
    shown.reserve(report["categories"].size());
    std::vector<ReportData> groups;
    for (const Json& category : report["categories"]) {
        const auto task =
            std::find_if(tasks.begin(), tasks.end(), [&](const auto& t) { return t.category == category["category"]; });
        const Json& meshes = category["splits"][0]["meshes"];
        std::vector<fs::path> paths;
        std::vector<std::string> names = load_model(folder_of(out_, *task) / "model.safetensors").label_names;
        for (const Json& mesh : meshes) {
            if (paths.size() < k_shown_meshes) paths.emplace_back(mesh["path"].get<std::string>());
            for (const std::string name : mesh["names"])
                if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        }
        shown.push_back(load_corpus(paths, names));
        groups.push_back(report_group(*task, category, shown.back()));
    }
    write_report_page(out_ / "index.html", title, groups);
}

}  // namespace exemplar
