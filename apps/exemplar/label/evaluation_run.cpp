#include "apps/exemplar/label/evaluation_run.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <deque>
#include <optional>

#include "apps/exemplar/commands.h"
#include "apps/exemplar/label/evaluation_page.h"
#include "apps/exemplar/label/labeled_output.h"
#include "apps/exemplar/label/learning_run.h"
#include "apps/exemplar/label/thesis_rates.h"
#include "apps/report/report_page.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/interrupt.h"
#include "host/core/json_text.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/labeling/evaluation/evaluation.h"
#include "host/labeling/inference/mesh_labeling.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Version of the labeling and of the scores; scores of another version are not reused.
constexpr int k_score_version = 4;

/// File beside NAME.json of every test mesh; no mesh has this name.
constexpr const char* k_training_report = "model.training.json";

std::string digest(const std::string& content) {
    return fmt::format("{:016x}", XXH3_64bits(content.data(), content.size()));
}

/// The content of a mesh's human segmentations.
std::string digest_of_humans(const fs::path& folder, const std::string& name) {
    std::string content;
    for (const fs::path& path : human_segmentation_files(folder, name)) content += read_file(path);
    return digest(content);
}

/// Everything that a model depends on: results of another run are not mixed into this one.
std::string evaluation_run_key(const EvaluationTask& task, const TrainOptions& train) {
    Json key = describe_options(train);
    for (const fs::path& path : task.train)
        key["train"].push_back({path.stem().string(), digest_of_labeled(path, task.labels)});
    return json_text(key);
}

/// The JSON of a file; null if it is missing or damaged.
Json read_json(const fs::path& path) {
    if (!fs::exists(path)) return nullptr;
    Json json = parse_json(read_file(path), nullptr, false);
    return json.is_object() ? json : Json(nullptr);
}

fs::path folder_of(const fs::path& out, const EvaluationTask& task) {
    return out / task.category / task.split;
}

/// Reads human segmentations and converts them from faces of the file to triangles.
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

/// For each label of merged training sets the sets that have it, in order of label.
Json label_sources(const LabeledCorpus& corpus, const std::vector<std::string>& sources) {
    std::vector<std::vector<std::string>> sets(corpus.names.size());
    for (std::size_t i = 0; i < corpus.meshes.size(); ++i)
        for (const std::int32_t label : corpus.meshes[i].label) {
            if (label < 0) continue;
            std::vector<std::string>& known = sets[static_cast<std::size_t>(label)];
            if (std::find(known.begin(), known.end(), sources[i]) == known.end()) known.push_back(sources[i]);
        }
    Json result = Json::array();
    for (std::size_t c = 0; c < sets.size(); ++c) result.push_back({{"label", corpus.names[c]}, {"sources", sets[c]}});
    return result;
}

void print_label_sources(const Json& labels) {
    fmt::print("labels of the merged training sets (equal names are one label):\n");
    for (const Json& label : labels)
        fmt::print("{:>20}  {}\n", label["label"].get<std::string>(),
                   fmt::join(label["sources"].get<std::vector<std::string>>(), ", "));
}

/// The labels that the model knows and that some test mesh has.
std::vector<std::string> shared_labels(const LabelingModel& model, const Json& meshes) {
    std::vector<std::string> shared;
    for (std::size_t c = 0; c < model.class_count(); ++c) {
        const bool occurs = std::any_of(meshes.begin(), meshes.end(), [&](const Json& mesh) {
            const std::size_t names = mesh["names"].size();
            double row = 0;
            for (std::size_t p = 0; p < names; ++p) row += mesh["confusion"][c * names + p].get<double>();
            return row > 0;
        });
        if (occurs) shared.push_back(model.label_names[c]);
    }
    return shared;
}

/// Returns the part of a training's report that the page and the report show.
Json training_of(const Json& run) {
    Json training = Json::object();
    for (const char* key : {"labels", "classifiers", "crf", "first_features", "seconds"})
        training[key] = run.contains(key) ? run[key] : Json(nullptr);
    return training;
}

/// Returns the rates to compare with if the task is of the benchmark; other data may have categories of the same
/// names.
std::optional<ThesisRates> benchmark_rates(const EvaluationTask& task) {
    if (task.humans.empty() || !task.labels.empty() || !task.sources.empty() || task.other_category) return {};
    return thesis_rates(task.category, task.train.size());
}

/// Adds the summary of a category to its splits.
void summarize_category(Json& category) {
    Json meshes = Json::array(), models = Json::array();
    for (const Json& split : category["splits"]) {
        for (const Json& mesh : split["meshes"]) meshes.push_back(mesh);
        models.push_back(split["features"]);
    }
    category.update(mean_rates(meshes));
    category.update(confusion_of(meshes));
    category["features"] = sum_chosen_features(models);
    category["meshes"] = meshes.size();
}

}  // namespace

std::string digest_of_labeled(const fs::path& mesh, const fs::path& labels_folder) {
    const fs::path labels = labels_path(mesh, labels_folder);
    return digest(read_file(mesh) + (fs::exists(labels) ? read_file(labels) : std::string()));
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
    const fs::path path = folder / "model.safetensors", run = folder / k_training_report;
    if (!finished(run, key).is_null() && fs::exists(path)) {
        try {
            return load_model(path);
        } catch (const ModelError&) {
            // Damaged: trained again below.
        }
    }
    const Stopwatch watch;
    const LabeledCorpus corpus = working_corpus(load_corpus(task.train, {}, task.labels));
    warn(corpus.warnings);
    TrainingFeatures features = training_features(corpus, train_.features, cache_, behavior_.memory);
    const double feature_seconds = watch.wall();
    TrainReport report;
    LabelingModel model = train_labeling(corpus, features, train_, backend_.labeling(), report);
    if (!behavior_.quiet) print_training(model, report);
    fs::remove(run);  // it describes the model
    save_model(path, model);
    Json json = describe_training(model, report);
    json["key"] = key;
    if (!task.sources.empty()) json["merged_labels"] = label_sources(corpus, task.sources);
    json["seconds"] = {{"features", feature_seconds}, {"all", watch.wall()}, {"cpu", watch.cpu()}};
    write_json(run, json);
    return model;
}

/// A test mesh may have labels that the training meshes lack: they follow those of the model. Unless the mesh is of
/// another category they can only be wrong, but they count.
LabeledCorpus EvaluationRun::load_test_mesh(const EvaluationTask& task, const fs::path& mesh,
                                            const LabelingModel& model) const {
    LabeledCorpus own = load_corpus({mesh}, {}, task.labels);
    for (const std::string& name : own.names) {
        if (task.other_category || std::ranges::find(model.label_names, name) != model.label_names.end()) continue;
        own.warnings.push_back(fmt::format("{}: no training mesh has the label '{}'{}: its faces will count as wrong",
                                           mesh.string(), name, suggestion(name, model.label_names)));
    }
    return with_label_order(std::move(own), model.label_names);
}

Json EvaluationRun::test_mesh(const EvaluationTask& task, const fs::path& mesh, const fs::path& folder,
                              const LabelingModel& model, const std::string& key) {
    const fs::path stem = folder / mesh.stem(), scores = stem.string() + ".json";
    const std::string mesh_key =
        fmt::format("{} {} {} scores {} {}", key, digest_of_labeled(mesh, task.labels),
                    digest_of_humans(task.humans, mesh.stem().string()), k_score_version, task.other_category);
    if (Json done = finished(scores, mesh_key); !done.is_null()) {
        done["path"] = mesh.string();  // the same mesh may have moved
        return done;
    }
    const Stopwatch watch;
    const LabeledCorpus corpus = load_test_mesh(task, mesh, model);
    warn(corpus.warnings);
    const LabeledMesh& item = corpus.meshes.front();
    const FaceLabeling labeling = label_mesh(model, item.mesh, cache_, backend_.labeling());
    Json seconds = Json::object();
    for (const auto& [stage, time] : labeling.seconds) seconds[stage] = time;
    const LabeledOutput output = make_labeled_output(item.mesh, model, labeling);
    write_labels_txt(stem.string() + "_labels.txt", output.labels);
    write_ply(stem.string() + ".ply", item.mesh, &output.labels, output.confidence);

    const Stopwatch scoring;
    const std::vector<float> areas = face_areas(item.mesh);
    std::vector<std::int32_t> rated = item.label;
    if (task.other_category)  // all labels are compared, but only those that both have are rated
        for (std::int32_t& label : rated)
            if (label >= static_cast<std::int32_t>(model.class_count())) label = -1;
    const auto score = [&](const std::vector<std::int32_t>& truth, const std::vector<std::int32_t>& predicted) {
        return score_labeling(areas, truth, predicted, corpus.names.size());
    };
    const MeshScore all = score(item.label, labeling.label);
    Json json = describe_scores(task.other_category ? score(rated, labeling.label) : all,
                                score(rated, most_probable_labels(labeling.probabilities, model.class_count())),
                                score_segmentation(item.mesh, labeling.label, human_segmentations(task.humans, item)));
    seconds["scores"] = scoring.wall(), seconds["all"] = watch.wall();
    json.update({{"key", mesh_key},
                 {"mesh", item.name},
                 {"path", mesh.string()},
                 {"names", corpus.names},
                 {"confusion", all.confusion},
                 {"seconds", seconds}});
    write_json(scores, json);
    return json;
}

Json EvaluationRun::run_task(const EvaluationTask& task, Progress& progress) {
    const fs::path folder = folder_of(out_, task);
    const std::string key = evaluation_run_key(task, train_);
    const LabelingModel model = model_for(task, folder, key);
    progress.advance(1, task.category + " trained");
    const Json run = read_json(folder / k_training_report);
    Json result{{"split", task.split},
                {"train", Json::array()},
                {"training", training_of(run)},
                {"features", chosen_features(model)},
                {"meshes", Json::array()}};
    for (const fs::path& path : task.train) result["train"].push_back(path.stem().string());
    if (run.contains("merged_labels")) {
        result["merged_labels"] = run["merged_labels"];
        if (!behavior_.quiet) print_label_sources(result["merged_labels"]);
    }
    for (const fs::path& mesh : task.test) {
        check_interrupt();
        result["meshes"].push_back(test_mesh(task, mesh, folder, model, key));
        result["meshes"].back().erase("key");
        progress.advance(1, task.category + "/" + mesh.stem().string());
    }
    if (behavior_.learning_curve) {
        result["learning_curve"] = learning_curve_of(task, backend_, cache_, train_.seed);
        if (!behavior_.quiet) fmt::print("{}: {}\n", task.category, learning_curve_text(result["learning_curve"]));
    }
    if (task.other_category) result["shared_labels"] = shared_labels(model, result["meshes"]);
    return result;
}

Json EvaluationRun::evaluate(const std::vector<EvaluationTask>& tasks, const std::string& protocol,
                             const std::string& title) {
    std::size_t steps = 0;
    for (const EvaluationTask& task : tasks) steps += 1 + task.test.size();
    Progress progress("evaluating", steps);
    Json categories = Json::array(), models = Json::array();
    for (const EvaluationTask& task : tasks) {
        if (categories.empty() || categories.back()["category"] != task.category)
            categories.push_back({{"category", task.category}, {"splits", Json::array()}});
        categories.back()["splits"].push_back(run_task(task, progress));
        models.push_back(categories.back()["splits"].back()["features"]);
        if (const auto thesis = benchmark_rates(task))
            categories.back()["thesis"] = {{"recognition_rate", thesis->recognition_rate},
                                           {"rand_error", thesis->rand_error}};
    }
    for (Json& category : categories) summarize_category(category);
    progress.finish();
    Json report{{"protocol", protocol}, {"device", backend_.device_name()}, {"options", describe_options(train_)}};
    report.update(mean_rates(categories));
    report["features"] = sum_chosen_features(models);
    report["categories"] = std::move(categories);
    write_page(tasks, report, title);
    return report;
}

void EvaluationRun::write_page(const std::vector<EvaluationTask>& tasks, const Json& report, const std::string& title) {
    std::deque<LabeledCorpus> shown;  // the page refers to the meshes, so they must stay where they are
    std::vector<ReportData> groups;
    for (const Json& category : report["categories"]) {
        const Json& split = category["splits"][0];
        const auto task =
            std::find_if(tasks.begin(), tasks.end(), [&](const auto& t) { return t.category == category["category"]; });
        const LabelingModel model = load_model(folder_of(out_, *task) / "model.safetensors");
        ReportData group = report_group(category);
        for (const std::size_t i : shown_meshes(split)) {
            shown.push_back(load_test_mesh(*task, split["meshes"][i]["path"].get<std::string>(), model));
            group.meshes.push_back(report_mesh(model, shown.back(), group.label_names));
            group.meshes.back().recognition_rate = rate_of(split["meshes"][i], "recognition_rate");
        }
        groups.push_back(std::move(group));
    }
    write_report_page((behavior_.report.empty() ? out_ : behavior_.report) / "index.html", title, groups,
                      behavior_.drawings);
}

/// `names`: the page's, which begin with those of the first model.
ReportMesh EvaluationRun::report_mesh(const LabelingModel& model, LabeledCorpus& shown,
                                      const std::vector<std::string>& names) {
    LabeledMesh& mesh = shown.meshes.front();
    FaceLabeling labeling = label_mesh(model, mesh.mesh, cache_, backend_.labeling());
    for (std::int32_t& label : mesh.label) {
        if (label < 0) continue;
        const auto found = std::find(names.begin(), names.end(), shown.names[static_cast<std::size_t>(label)]);
        label = static_cast<std::int32_t>(found - names.begin());
    }
    ReportMesh result;
    result.name = mesh.name;
    result.mesh = &mesh.mesh;
    result.predicted = std::move(labeling.label);
    result.truth = mesh.label;
    result.confidence = std::move(labeling.confidence);
    result.entropy = relative_entropy(labeling.probabilities, model.class_count());
    result.border = std::move(labeling.border);
    return result;
}

}  // namespace exemplar
