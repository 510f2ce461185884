// exemplar label evaluate: trains on some labeled meshes, labels others, and reports how well that went.

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <set>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/evaluation_run.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct EvaluateCommand {
    CommonOptions common;
    fs::path train_list, test_list, folder, out, humans;
    fs::path cache = default_feature_folder();
    std::string protocol;
    std::optional<std::size_t> splits;
    bool fresh = false;
    TrainOptions train;
};

/// Training set size of a protocol; 0 for leave-one-out.
std::size_t protocol_size(const std::string& protocol) {
    if (protocol == "sb3") return 3;
    if (protocol == "sb6") return 6;
    if (protocol == "sb12") return 12;
    return 0;
}

/// Labels lie beside a mesh, or in the mesh file itself.
bool may_be_labeled(const fs::path& file) {
    const std::string extension = file.extension().string();
    return file.filename().string().ends_with("_labels.txt") || extension == ".ply" || extension == ".glb";
}

/// The folders below `folder` that hold labeled meshes, or the folder itself.
std::vector<fs::path> category_folders(const fs::path& folder) {
    std::set<fs::path> categories;
    if (folder.empty()) throw UsageError("--protocol needs the folder of a category, or of several");
    require_input(folder);
    if (!fs::is_directory(folder)) throw UsageError(fmt::format("{}: is no folder", folder.string()));
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (!entry.is_directory()) continue;
        for (const auto& file : fs::directory_iterator(entry.path()))
            if (may_be_labeled(file.path())) categories.insert(entry.path());
    }
    if (categories.empty()) categories.insert(folder);
    return {categories.begin(), categories.end()};
}

/// An absolute path whose last part is a name.
fs::path without_trailing_slash(const fs::path& path) {
    const fs::path absolute = fs::absolute(path).lexically_normal();
    return absolute.has_filename() ? absolute : absolute.parent_path();
}

/// The benchmark keeps human segmentations in seg/ beside labeled/, or the user says where they are.
fs::path human_folder(const EvaluateCommand& options, const fs::path& category) {
    if (!options.humans.empty()) {
        require_input(options.humans);
        return options.humans;
    }
    for (const fs::path& candidate : {category.parent_path().parent_path() / "seg", category.parent_path() / "seg"})
        if (fs::is_directory(candidate)) return candidate;
    return {};
}

std::vector<EvaluationTask> protocol_tasks(const EvaluateCommand& options) {
    std::vector<EvaluationTask> tasks;
    if (options.protocol == "sb19" && options.splits)
        throw UsageError("--splits does not apply to sb19, which leaves out each mesh in turn");
    for (const fs::path& folder : category_folders(options.folder)) {
        const fs::path category = without_trailing_slash(folder);
        const std::vector<fs::path> meshes = list_meshes(category);
        require_distinct_names(meshes);
        const std::size_t size = protocol_size(options.protocol);
        const std::vector<Split> splits =
            make_splits(meshes.size(), size ? size : meshes.size() - 1,
                        size ? options.splits.value_or(1) : meshes.size(), options.train.seed);
        for (std::size_t k = 0; k < splits.size(); ++k) {
            EvaluationTask task{category.filename().string(),
                                fmt::format("{}-{}", options.protocol, k),
                                {},
                                {},
                                human_folder(options, category)};
            for (const std::size_t i : splits[k].train) task.train.push_back(meshes[i]);
            for (const std::size_t i : splits[k].test) task.test.push_back(meshes[i]);
            tasks.push_back(std::move(task));
        }
    }
    return tasks;
}

/// Meshes that were trained on are labeled too well.
void warn_of_common(const std::vector<fs::path>& train, const std::vector<fs::path>& test) {
    std::set<fs::path> trained;
    for (const fs::path& path : train) trained.insert(fs::weakly_canonical(path));
    for (const fs::path& path : test)
        if (trained.contains(fs::weakly_canonical(path)))
            fmt::print(stderr,
                       "warning: {}: is among the training meshes too; its rates are not those of an unseen mesh\n",
                       path.string());
}

std::vector<EvaluationTask> make_tasks(const EvaluateCommand& options) {
    if (!options.protocol.empty()) return protocol_tasks(options);
    if (options.train_list.empty() || options.test_list.empty())
        throw UsageError("give --train LIST and --test LIST, or --protocol sb3|sb6|sb12|sb19 DIR");
    EvaluationTask task{without_trailing_slash(options.train_list).stem().string(),
                        "lists",
                        meshes_of_argument(options.train_list),
                        meshes_of_argument(options.test_list),
                        {}};
    require_distinct_names(task.test);
    if (!options.common.quiet) warn_of_common(task.train, task.test);
    task.humans = human_folder(options, fs::absolute(task.test.front()).parent_path());
    return {task};
}

std::string percent(double rate) {
    return std::isnan(rate) ? std::string("-") : fmt::format("{:.1f}", 100 * rate);
}

void run_evaluate(const EvaluateCommand& options) {
    const auto limits = apply_common_options(options.common);
    require_output_folder(options.out);
    const std::vector<EvaluationTask> tasks = make_tasks(options);
    DeviceBackend backend(options.common.device);
    EvaluationRun run(backend, options.train, usable_cache(options.cache, options.common.quiet), options.out,
                      {.quiet = options.common.quiet, .fresh = options.fresh});
    const nlohmann::json report =
        run.evaluate(tasks, options.protocol.empty() ? "lists" : options.protocol, "Mesh labeling on unseen shapes");

    fmt::print("{:>12} {:>6} {:>7} {:>7} {:>7}\n", "category", "meshes", "RR", "SW", "RI err");
    for (const auto& category : report["categories"])
        fmt::print("{:>12} {:>6} {:>7} {:>7} {:>7}\n", category["category"].get<std::string>(),
                   category["meshes"].get<std::size_t>(), percent(rate_of(category, "recognition_rate")),
                   percent(rate_of(category, "segment_weighted_accuracy")), percent(rate_of(category, "rand_error")));
    fmt::print("report: {}\n", (options.out / "index.html").string());
    write_json(options.out / "report.json", report);
    write_report(options.common, report);
}

}  // namespace

void add_evaluate_command(CLI::App& label) {
    auto options = std::make_shared<EvaluateCommand>();
    CLI::App* command =
        label.add_subcommand("evaluate", "Trains on some labeled meshes, tests on others, reports the accuracy");
    command->footer(
        "Interrupted, it goes on where it stopped when called again with the same options.\n\nExamples:\n"
        "  exemplar label evaluate --train train.txt --test test.txt --out report\n"
        "  exemplar label evaluate --protocol sb6 psb/labeled/Cup --splits 2 --out report");
    CLI::Option* train =
        command->add_option("--train", options->train_list, "training meshes: folder or list")->type_name("");
    CLI::Option* test = command->add_option("--test", options->test_list, "test meshes: folder or list")->type_name("");
    CLI::Option* protocol =
        command->add_option("--protocol", options->protocol,
                            "train on 3, 6 or 12 random meshes of each category, or on all but one (sb19)");
    protocol->check(CLI::IsMember({"sb3", "sb6", "sb12", "sb19"}))->type_name("")->excludes(train)->excludes(test);
    command->add_option("DIR", options->folder, "category folder, or folder of category folders, for --protocol")
        ->needs(protocol)
        ->type_name("");
    command->add_option("--splits", options->splits, "random splits per category, one unless given; not for sb19")
        ->check(whole_number(1, 1000))
        ->needs(protocol);
    command->add_option("--humans", options->humans, "folder of human segmentations, NAME/*.seg, for the Rand index")
        ->type_name("FOLDER");
    command->add_option("--out", options->out, "folder for models, labels and the report")
        ->required()
        ->type_name("FOLDER");
    command->add_flag("--fresh", options->fresh, "start over instead of going on from what is in --out");
    add_training_options(*command, options->train, options->cache);
    add_common_options(*command, options->common);
    command->callback([options] { run_evaluate(*options); });
}

}  // namespace exemplar
