// exemplar label study: compares ways of training on training meshes alone, so that no test mesh takes part in a
// choice.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/label/category_folders.h"
#include "apps/exemplar/label/evaluation_run.h"
#include "apps/exemplar/label/evaluation_summary.h"
#include "apps/exemplar/label/training_run.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/interrupt.h"
#include "host/core/json_text.h"
#include "host/core/progress.h"
#include "host/core/random.h"
#include "host/core/stopwatch.h"
#include "host/labeling/evaluation/evaluation.h"
#include "host/labeling/evaluation/paired_difference.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/labeling/painting/suggestions.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A rate of a held-out mesh.
struct StudyRate {
    const char* key;
    const char* column;
    double factor;  ///< from the report's unit to the printed one
};
constexpr StudyRate k_study_rates[] = {{"recognition_rate", "RR %", 100},
                                       {"segment_weighted_accuracy", "SW %", 100},
                                       {"without_cut", "no cut %", 100},
                                       {"log_loss", "log loss", 1}};
constexpr double k_least_probability = 1e-4;  ///< in the log loss, so that no single face decides

struct StudyCommand {
    CommonOptions common;
    fs::path folder, out, against;
    std::vector<std::string> without;
    fs::path cache = default_feature_folder();
    std::size_t size = 6, splits = 5, held = 2, faces = 4000;
    TrainOptions train;
};

/// A training on some meshes of a category, and the meshes that it is judged by.
struct StudyTask {
    std::string category;
    std::size_t split, group;
    std::vector<std::size_t> train, held_out;  ///< indices of meshes
};

/// Divides the training meshes of each split into groups that are held out in turn.
std::vector<StudyTask> study_tasks(const StudyCommand& options, const std::string& category, std::size_t meshes) {
    std::vector<StudyTask> tasks;
    const std::vector<Split> splits = make_splits(meshes, options.size, options.splits, options.train.seed);
    for (std::size_t split = 0; split < splits.size(); ++split) {
        std::vector<std::size_t> order = splits[split].train;
        Random(options.train.seed).fork(split).shuffle(order);
        for (std::size_t begin = 0; begin < order.size(); begin += options.held) {
            StudyTask task{category, split, begin / options.held, {}, {}};
            for (std::size_t i = 0; i < order.size(); ++i)
                (i / options.held == task.group ? task.held_out : task.train).push_back(order[i]);
            std::sort(task.train.begin(), task.train.end());
            tasks.push_back(std::move(task));
        }
    }
    return tasks;
}

/// The meshes of one category with the features of those that the tasks use.
struct StudyCategory {
    LabeledCorpus corpus;
    std::vector<MeshFeatures> features;
};

StudyCategory load_category(const StudyCommand& options, const fs::path& cache, const std::vector<fs::path>& meshes,
                            std::span<const StudyTask> tasks) {
    StudyCategory category{working_corpus(load_corpus(meshes), options.faces), {}};
    if (!options.common.quiet)
        for (const std::string& warning : category.corpus.warnings) fmt::print(stderr, "warning: {}\n", warning);
    std::set<std::size_t> used;
    for (const StudyTask& task : tasks) {
        used.insert(task.train.begin(), task.train.end());
        used.insert(task.held_out.begin(), task.held_out.end());
    }
    category.features.resize(meshes.size());
    Progress progress("computing features", used.size());
    for (const std::size_t mesh : used) {
        check_interrupt();
        category.features[mesh] = cached_features(category.corpus.meshes[mesh].mesh, options.train.features, cache);
        progress.advance(1, category.corpus.meshes[mesh].name);
    }
    return category;
}

/// The area-weighted mean of -log P(true label). Labels that no training mesh has are left out.
double log_loss(const MeshFeatures& features, std::span<const std::int32_t> truth, std::span<const float> probabilities,
                std::size_t classes) {
    double sum = 0, area = 0;
    for (std::size_t f = 0; f < truth.size(); ++f) {
        if (truth[f] < 0 || static_cast<std::size_t>(truth[f]) >= classes) continue;
        const double p = probabilities[f * classes + static_cast<std::size_t>(truth[f])];
        sum -= static_cast<double>(features.face_area[f]) * std::log(std::max(p, k_least_probability));
        area += static_cast<double>(features.face_area[f]);
    }
    return area > 0 ? sum / area : std::numeric_limits<double>::quiet_NaN();
}

/// Labels one held-out mesh and returns its rates.
Json judge_held_out(const LabelingModel& model, const LabeledMesh& mesh, const std::vector<std::string>& names,
                    MeshFeatures& features, DeviceBackend& backend) {
    const LabeledCorpus own = with_label_order({names, {mesh}, {}}, model.label_names);
    const std::vector<std::int32_t>& truth = own.meshes.front().label;
    const std::size_t labels = own.names.size();  // those that only this mesh has come last, and count as wrong
    const FaceLabeling labeling = label_faces(model, features, backend.labeling());
    const MeshScore score = score_labeling(features.face_area, truth, labeling.label, labels);
    const MeshScore uncut = score_labeling(features.face_area, truth,
                                           most_probable_labels(labeling.probabilities, model.class_count()), labels);
    return {{"mesh", mesh.name},
            {"recognition_rate", rate_json(score.recognition_rate)},
            {"segment_weighted_accuracy", rate_json(score.segment_weighted_accuracy)},
            {"turned", labeling.turned},
            {"without_cut", rate_json(uncut.recognition_rate)},
            {"log_loss", rate_json(log_loss(features, truth, labeling.probabilities, model.class_count()))}};
}

/// Trains without the held-out meshes and judges them. Returns the rows of the report.
Json run_study_task(const StudyTask& task, const TrainOptions& options, StudyCategory& category,
                    DeviceBackend& backend) {
    LabeledCorpus corpus{category.corpus.names, {}, {}};
    std::vector<MeshFeatures> features;
    for (const std::size_t i : task.train) {
        corpus.meshes.push_back(category.corpus.meshes[i]);
        features.push_back(std::move(category.features[i]));
    }
    TrainReport report;
    const Stopwatch watch;
    const LabelingModel model =
        train_labeling(without_unused_labels(std::move(corpus)), features, options, backend.labeling(), report);
    const double seconds = watch.wall();
    for (std::size_t i = 0; i < task.train.size(); ++i) category.features[task.train[i]] = std::move(features[i]);
    Json rows = Json::array();
    for (const std::size_t i : task.held_out) {
        rows.push_back(
            judge_held_out(model, category.corpus.meshes[i], category.corpus.names, category.features[i], backend));
        rows.back().update(
            {{"category", task.category}, {"split", task.split}, {"group", task.group}, {"seconds", seconds}});
    }
    return rows;
}

/// The report of a study; null if the file holds something else.
Json read_study(const fs::path& path) {
    Json report = parse_json(read_file(path), nullptr, false);
    const bool is_study = report.is_object() && report.contains("options") && report.contains("rows");
    return is_study ? report : Json(nullptr);
}

/// The rows of an interrupted study. Refuses to replace one of other options or meshes, or another file.
Json rows_of_earlier(const fs::path& path, const Json& options) {
    if (!fs::exists(path)) return Json::array();
    Json report = read_study(path);
    if (report.is_object() && report["options"] == options) return std::move(report["rows"]);
    throw UsageError(
        fmt::format("{}: is no study of these meshes with these options; give another --out", path.string()));
}

/// The rows to compare with; null if there is nothing to compare with.
Json rows_to_compare(const fs::path& path) {
    if (path.empty()) return nullptr;
    require_input(path);
    Json report = read_study(path);
    if (report.is_null())
        throw DataError(
            fmt::format("{}: is no study; give a file that 'exemplar label study --out' wrote", path.string()));
    return std::move(report["rows"]);
}

/// Everything that the results depend on: the options, and the content of each mesh file with its labels.
Json describe_study(const StudyCommand& options, const std::vector<fs::path>& folders) {
    Json described = describe_options(options.train);
    described.update(
        {{"size", options.size}, {"splits", options.splits}, {"held", options.held}, {"faces", options.faces}});
    for (const fs::path& folder : folders)
        for (const fs::path& mesh : list_meshes(folder))
            described["meshes"].push_back(fmt::format("{}/{} {}", without_trailing_slash(folder).filename().string(),
                                                      mesh.stem().string(), digest_of_labeled(mesh)));
    return described;
}

/// A held-out mesh of a split.
std::string row_name(const Json& row) {
    return fmt::format("{}/{}/{}", row["category"].get<std::string>(), row["split"].get<std::size_t>(),
                       row["mesh"].get<std::string>());
}

bool is_done(const Json& rows, const StudyTask& task) {
    return std::any_of(rows.begin(), rows.end(), [&](const Json& row) {
        return row["category"] == task.category && row["split"] == task.split && row["group"] == task.group;
    });
}

/// The rates of rows without those of some categories, minus those of `other` of the same key if it is given.
std::vector<PairedDifference> rates_of(const Json& rows, const char* key, const std::set<std::string>& without,
                                       const std::map<std::string, double>* other = nullptr) {
    std::vector<PairedDifference> rates;
    for (const Json& row : rows) {
        const auto category = row["category"].get<std::string>();
        const double rate = rate_of(row, key);
        if (without.contains(category) || std::isnan(rate)) continue;
        if (!other) {
            rates.push_back({category, row["mesh"], rate});
        } else if (const auto found = other->find(row_name(row)); found != other->end() && !std::isnan(found->second)) {
            rates.push_back({category, row["mesh"], rate - found->second});
        }
    }
    return rates;
}

void print_study(const Json& rows, const std::set<std::string>& without) {
    std::set<std::string> categories;
    for (const Json& row : rows) categories.insert(row["category"].get<std::string>());
    fmt::print("{:>20}", "category");
    for (const StudyRate& rate : k_study_rates) fmt::print(" {:>9}", rate.column);
    fmt::print("\n");
    const auto line = [&](const std::string& name, const std::set<std::string>& left_out) {
        fmt::print("{:>20}", name);
        for (const StudyRate& rate : k_study_rates)
            fmt::print(" {:>9.3f}", rate.factor * mean_over_categories(rates_of(rows, rate.key, left_out)));
        fmt::print("\n");
    };
    for (const std::string& category : categories) {
        std::set<std::string> others = categories;
        others.erase(category);
        line(category, others);
    }
    line("mean", {});
    if (!without.empty()) line("mean without " + fmt::format("{}", fmt::join(without, ", ")), without);
}

/// Prints by how much the rates are above those of another study, on the meshes that both have, and returns it.
Json compare_studies(const Json& rows, const Json& other, const std::set<std::string>& without) {
    Json result = Json::object();
    for (const StudyRate& rate : k_study_rates) {
        std::map<std::string, double> others;
        for (const Json& row : other) others[row_name(row)] = rate_of(row, rate.key);
        const auto compare = [&](const char* what, const std::set<std::string>& left_out) {
            const std::vector<PairedDifference> differences = rates_of(rows, rate.key, left_out, &others);
            const DifferenceEstimate estimate = estimate_difference(differences);
            fmt::print("{:>20} {:>9} {:+.3f}  (95 %: {:+.3f} to {:+.3f}; {} labelings)\n", what, rate.column,
                       rate.factor * estimate.mean, rate.factor * estimate.lowest, rate.factor * estimate.highest,
                       differences.size());
            return Json{{"mean", rate_json(estimate.mean)},
                        {"lowest", rate_json(estimate.lowest)},
                        {"highest", rate_json(estimate.highest)}};
        };
        result[rate.key]["all"] = compare("difference", {});
        if (!without.empty()) result[rate.key]["without"] = compare("without these", without);
    }
    return result;
}

/// Studies one category: adds a row per held-out mesh to the report, and writes it after each training.
void study_category(const StudyCommand& options, const fs::path& folder, const fs::path& cache, DeviceBackend& backend,
                    Progress& progress, Json& report) {
    const std::string name = without_trailing_slash(folder).filename().string();
    const std::vector<fs::path> meshes = list_meshes(folder);
    require_distinct_names(meshes);
    if (meshes.size() <= options.size)
        throw UsageError(
            fmt::format("{}: has {} meshes, but --size {} needs more", folder.string(), meshes.size(), options.size));
    std::vector<StudyTask> tasks = study_tasks(options, name, meshes.size());
    const std::size_t all = tasks.size();
    std::erase_if(tasks, [&](const StudyTask& task) { return is_done(report["rows"], task); });
    progress.advance(all - tasks.size(), name);
    if (tasks.empty()) return;
    StudyCategory category = load_category(options, cache, meshes, tasks);
    for (const StudyTask& task : tasks) {
        check_interrupt();
        for (Json& row : run_study_task(task, options.train, category, backend))
            report["rows"].push_back(std::move(row));
        write_json(options.out, report);
        progress.advance(1, name);
    }
}

void run_label_study(const StudyCommand& options) {
    const auto limits = apply_common_options(options.common);
    require_output_file(options.out);
    if (options.held >= options.size)
        throw UsageError("--held must be below --size: some meshes must be left to learn");
    const fs::path cache = usable_cache(options.cache, options.common.quiet);
    DeviceBackend backend(options.common.device);
    const std::vector<fs::path> folders = category_folders(options.folder);
    const Json described = describe_study(options, folders), other = rows_to_compare(options.against);
    Json report{{"options", described}, {"rows", rows_of_earlier(options.out, described)}};

    const std::size_t groups = (options.size + options.held - 1) / options.held;
    Progress progress("studying", folders.size() * options.splits * groups);
    for (const fs::path& folder : folders) study_category(options, folder, cache, backend, progress, report);
    progress.finish();
    const std::set<std::string> without(options.without.begin(), options.without.end());
    print_study(report["rows"], without);
    if (!other.is_null()) report["difference"] = compare_studies(report["rows"], other, without);
    write_json(options.out, report);
    write_report(options.common, report);
}

}  // namespace

void add_study_command(Command& label) {
    auto options = std::make_shared<StudyCommand>();
    Command* command =
        label.add_subcommand("study", "Compares ways of training, by training meshes that are held out in turn");
    command->footer(
        "Draws the training meshes of each split as 'label evaluate --protocol' does, and never looks at the others.\n"
        "Interrupted, it goes on where it stopped when called again with the same options.\n\nExample:\n"
        "  exemplar label study psb/labeled --out default.json\n"
        "  exemplar label study psb/labeled --rounds 1000 --out more.json --against default.json --without Bust");
    command->add_option("DIR", options->folder, "category folder, or folder of category folders")
        ->required()
        ->type_name("");
    command->add_option("--out", options->out, "file of the results, .json")->required()->type_name("FILE");
    command->add_option("--against", options->against, "results to compare with, mesh by mesh")->type_name("FILE");
    command->add_option("--without", options->without, "also give the means without these categories")
        ->type_name("NAME");
    command->add_option("--size", options->size, "training meshes of a split")
        ->capture_default_str()
        ->check(whole_number(2, 100000));
    command->add_option("--splits", options->splits, "random splits per category")
        ->capture_default_str()
        ->check(whole_number(1, 1000));
    command->add_option("--held", options->held, "training meshes that are held out at a time")
        ->capture_default_str()
        ->check(whole_number(1, 1000));
    command->add_option("--faces", options->faces, "meshes are simplified to about so many faces, to be quick")
        ->capture_default_str()
        ->check(whole_number(100, k_max_working_faces));
    add_training_options(*command, options->train, options->cache);
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_label_study(*options); });
}

}  // namespace exemplar
