// exemplar label evaluate: trains on some labeled meshes, labels others, and reports how well that went.

#include <fmt/format.h>
#include <stdlib.h>  // mkdtemp

#include <cerrno>
#include <cstring>
#include <optional>
#include <set>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/label/category_folders.h"
#include "apps/exemplar/label/evaluation_run.h"
#include "apps/exemplar/label/peer_labels.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct EvaluateCommand {
    CommonOptions common;
    std::vector<fs::path> train_sets, test_sets, train_on, test_on;
    fs::path folder, out, report, humans, labels, peer;
    fs::path cache = default_feature_folder();
    std::string protocol;
    std::optional<std::size_t> splits;
    bool fresh = false, curve = false;
    double memory = k_feature_gigabytes;
    TrainOptions train;
};

/// A temporary folder, removed with its contents.
class ScratchFolder {
  public:
    ScratchFolder() {
        std::string name = (fs::temp_directory_path() / "exemplar-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            throw DataError(fmt::format("{}: no folder can be made ({}); give --out", name, std::strerror(errno)));
        path_ = name;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

/// Training set size of a protocol; 0 for leave-one-out.
std::size_t protocol_size(const std::string& protocol) {
    if (protocol == "sb3") return 3;
    if (protocol == "sb6") return 6;
    if (protocol == "sb12") return 12;
    return 0;
}

/// Returns the folder of human segmentations: the user's, else the benchmark's seg/ beside labeled/, else empty.
fs::path human_folder(const EvaluateCommand& options, const fs::path& category) {
    if (!options.humans.empty()) {
        require_input(options.humans);
        return options.humans;
    }
    for (const fs::path& candidate : {category.parent_path().parent_path() / "seg", category.parent_path() / "seg"})
        if (fs::is_directory(candidate)) return candidate;
    return {};
}

/// The split that ShapePFCN (Kalogerakis et al., CVPR 2017) was tested on: of each five meshes, in the order of their
/// numbers, the third and the fifth are test meshes.
Split pfcn_split(const fs::path& category, const std::vector<fs::path>& meshes) {
    if (meshes.size() < 5)
        throw UsageError(fmt::format("{}: pfcn splits five meshes or more, not {}", category.string(), meshes.size()));
    Split split;
    for (std::size_t i = 0; i < meshes.size(); ++i) (i % 5 == 2 || i % 5 == 4 ? split.test : split.train).push_back(i);
    return split;
}

/// Divides the meshes of a category as the protocol does.
std::vector<Split> protocol_splits(const EvaluateCommand& options, const fs::path& category,
                                   const std::vector<fs::path>& meshes) {
    if (options.protocol == "pfcn") return {pfcn_split(category, meshes)};
    const std::size_t size = protocol_size(options.protocol);
    return make_splits(meshes.size(), size ? size : meshes.size() - 1,
                       size ? options.splits.value_or(1) : meshes.size(), options.train.seed);
}

std::vector<EvaluationTask> protocol_tasks(const EvaluateCommand& options) {
    std::vector<EvaluationTask> tasks;
    if (options.protocol == "sb19" && options.splits)
        throw UsageError("--splits does not apply to sb19, which leaves out each mesh in turn");
    if (options.protocol == "pfcn" && options.splits)
        throw UsageError("--splits does not apply to pfcn, a single split");
    if (options.folder.empty()) throw UsageError("--protocol needs the folder of a category, or of several");
    for (const fs::path& folder : category_folders(options.folder, options.labels)) {
        const fs::path category = without_trailing_slash(folder);
        const std::vector<fs::path> meshes = list_meshes(category);
        require_distinct_names(meshes);
        const std::vector<Split> splits = protocol_splits(options, category, meshes);
        for (std::size_t k = 0; k < splits.size(); ++k) {
            EvaluationTask task{category.filename().string(),
                                fmt::format("{}-{}", options.protocol, k),
                                {},
                                {},
                                human_folder(options, category),
                                options.labels};
            for (const std::size_t i : splits[k].train) task.train.push_back(meshes[i]);
            for (const std::size_t i : splits[k].test) task.test.push_back(meshes[i]);
            tasks.push_back(std::move(task));
        }
    }
    return tasks;
}

/// Warns of test meshes that are also trained on, as they are labeled too well.
void warn_of_common(const std::vector<fs::path>& train, const std::vector<fs::path>& test) {
    std::set<fs::path> trained;
    for (const fs::path& path : train) trained.insert(fs::weakly_canonical(path));
    for (const fs::path& path : test)
        if (trained.contains(fs::weakly_canonical(path)))
            fmt::print(stderr,
                       "warning: {}: is among the training meshes too; its rates are not those of an unseen mesh\n",
                       path.string());
}

/// The union of mesh sets (folders, lists or mesh files).
struct MeshUnion {
    std::string name;                  ///< of the sets, joined by +
    std::vector<fs::path> meshes;      ///< a mesh that is in several sets once
    std::vector<std::string> sources;  ///< per mesh the set it is from; empty if there is only one set
};

MeshUnion merge_sets(const std::vector<fs::path>& sets) {
    MeshUnion result;
    std::set<fs::path> known;
    for (const fs::path& set : sets) {
        const std::string name = without_trailing_slash(set).stem().string();
        result.name += (result.name.empty() ? "" : "+") + name;
        for (const fs::path& mesh : meshes_of_argument(set)) {
            if (sets.size() > 1 && !known.insert(fs::weakly_canonical(mesh)).second) continue;
            result.meshes.push_back(mesh);
            if (sets.size() > 1) result.sources.push_back(name);
        }
    }
    return result;
}

/// The one task of --train and --test, or of --train-on and --test-on.
EvaluationTask set_task(const EvaluateCommand& options) {
    const bool other_category = !options.train_on.empty();
    MeshUnion train = merge_sets(other_category ? options.train_on : options.train_sets);
    MeshUnion test = merge_sets(other_category ? options.test_on : options.test_sets);
    require_distinct_names(test.meshes);
    if (!options.common.quiet) warn_of_common(train.meshes, test.meshes);
    EvaluationTask task{other_category ? train.name + "-to-" + test.name : train.name,
                        other_category ? "category" : "lists",
                        std::move(train.meshes),
                        std::move(test.meshes),
                        {},
                        options.labels,
                        std::move(train.sources),
                        other_category};
    task.humans = human_folder(options, fs::absolute(task.test.front()).parent_path());
    return task;
}

std::vector<EvaluationTask> tasks_of(const EvaluateCommand& options) {
    if (!options.labels.empty()) require_input(options.labels);
    if (!options.peer.empty()) require_input(options.peer);
    if (!options.protocol.empty()) return protocol_tasks(options);
    if (options.train_on.empty() != options.test_on.empty()) throw UsageError("--train-on and --test-on go together");
    if (options.train_on.empty() && (options.train_sets.empty() || options.test_sets.empty()))
        throw UsageError(
            "give --train SET and --test SET, --train-on SET and --test-on SET, or --protocol sb3|sb6|sb12|sb19|pfcn "
            "DIR");
    return {set_task(options)};
}

std::vector<EvaluationTask> make_tasks(const EvaluateCommand& options) {
    std::vector<EvaluationTask> tasks = tasks_of(options);
    if (!options.peer.empty()) require_peer(tasks, options.peer);
    return tasks;
}

std::string protocol_name(const EvaluateCommand& options) {
    if (!options.protocol.empty()) return options.protocol;
    return options.train_on.empty() ? "lists" : "category";
}

void run_label_evaluate(const EvaluateCommand& options) {
    const auto limits = apply_common_options(options.common);
    if (options.out.empty() && options.report.empty())
        throw UsageError("give --out FOLDER for models, labels and the page, or --report FOLDER for the page alone");
    for (const fs::path& folder : {options.out, options.report})
        if (!folder.empty()) require_output_folder(folder);
    const std::vector<EvaluationTask> tasks = make_tasks(options);
    std::optional<ScratchFolder> scratch;
    if (options.out.empty()) scratch.emplace();
    const fs::path out = scratch ? scratch->path() : options.out;
    DeviceBackend backend(options.common.device);
    EvaluationRun run(backend, options.train, usable_cache(options.cache, options.common.quiet), out,
                      {.quiet = options.common.quiet,
                       .fresh = options.fresh,
                       .learning_curve = options.curve,
                       .memory = options.memory,
                       .report = options.report});
    nlohmann::json report = run.evaluate(tasks, protocol_name(options), "Mesh labeling on unseen shapes");

    print_evaluation(report);
    if (!options.peer.empty()) {
        compare_with_peer(report, tasks, options.peer);
        print_peer(report);
    }
    fmt::print("\nreport: {}\n", ((options.report.empty() ? out : options.report) / "index.html").string());
    if (!scratch) write_json(out / "report.json", report);
    write_report(options.common, report);
}

/// --train and --test, or --train-on and --test-on, and the protocols that take their place.
void add_mesh_options(Command& command, EvaluateCommand& options) {
    Option* train = command.add_option("--train", options.train_sets,
                                       "training meshes: a folder or list, or several that are merged");
    Option* test = command.add_option("--test", options.test_sets, "test meshes: folders or lists");
    Option* train_on =
        command.add_option("--train-on", options.train_on, "training meshes of another category than --test-on");
    Option* test_on = command.add_option("--test-on", options.test_on,
                                         "test meshes of it; rated by the label names that both categories have");
    for (Option* option : {train_on, test_on}) option->excludes(train)->excludes(test);
    Option* protocol =
        command.add_option("--protocol", options.protocol,
                           "train on 3, 6 or 12 random meshes of each category, on all but one (sb19), or on three "
                           "of each five (pfcn: the split that ShapePFCN was tested on)");
    protocol->check(one_of({"sb3", "sb6", "sb12", "sb19", "pfcn"}))->type_name("");
    for (Option* option : {train, test, train_on, test_on}) {
        option->type_name("SET");
        protocol->excludes(option);
    }
    command.add_option("DIR", options.folder, "category folder, or folder of category folders, for --protocol")
        ->needs(protocol)
        ->type_name("");
    command
        .add_option("--splits", options.splits, "random splits per category, one unless given; not for sb19 and pfcn")
        ->check(whole_number(1, 1000))
        ->needs(protocol);
    command
        .add_option("--humans", options.humans, "folder of human segmentations, NAME/*.seg, to compare segments with")
        ->type_name("FOLDER");
    command
        .add_option("--peer", options.peer,
                    "folder of another program's labels of the test meshes, CATEGORY/NAME_labels.txt, to compare with")
        ->type_name("FOLDER");
    command
        .add_option("--labels", options.labels,
                    "folder of NAME_labels.txt to learn and test, in place of those beside the meshes")
        ->type_name("FOLDER");
}

}  // namespace

void add_evaluate_command(Command& label) {
    auto options = std::make_shared<EvaluateCommand>();
    Command* command =
        label.add_subcommand("evaluate", "Trains on some labeled meshes, tests on others, reports the accuracy");
    command->footer(
        "Interrupted, it goes on where it stopped when called again with the same options and --out.\n\nExamples:\n"
        "  exemplar label evaluate --train train.txt --test test.txt --out report\n"
        "  exemplar label evaluate --protocol sb6 psb/labeled/Cup --splits 2 --out report\n"
        "  exemplar label evaluate --train train.txt --test test.txt --report page     (only the page)\n"
        "another category than the one learned:\n"
        "  exemplar label evaluate --train-on psb/labeled/FourLeg --test-on psb/labeled/Human --out report\n"
        "several categories as one, where equal label names are one label:\n"
        "  exemplar label evaluate --train human.txt teddy.txt --test more-humans.txt more-teddies.txt --out report\n"
        "labels of another style for the same meshes:\n"
        "  exemplar label evaluate --train train.txt --test test.txt --labels three-torsos --out report");
    add_mesh_options(*command, *options);
    command->add_option("--out", options->out, "folder for models, labels, scores and, without --report, the page")
        ->type_name("FOLDER");
    command->add_option("--report", options->report, "folder for the page; without --out nothing else is kept")
        ->type_name("FOLDER");
    command->add_flag("--fresh", options->fresh, "start over instead of going on from what is in --out");
    command->add_flag("--curve", options->curve,
                      "also measure the rate against the number of training meshes, what three more would gain, and "
                      "which mesh to label next");
    add_training_options(*command, options->train, options->cache);
    add_feature_memory_option(*command, options->memory);
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_label_evaluate(*options); });
}

}  // namespace exemplar
