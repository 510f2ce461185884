// exemplar label batch: labels all shapes of a catalog or a folder, overnight if need be.

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "apps/exemplar/batch_page.h"
#include "apps/exemplar/batch_run.h"
#include "apps/exemplar/batch_shards.h"
#include "apps/exemplar/batch_slurm.h"
#include "apps/exemplar/catalog_add.h"
#include "apps/exemplar/commands.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/freed_memory.h"
#include "host/core/interrupt.h"
#include "host/core/memory_budget.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/labeling/feature_cache.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// How shapes are labeled and what is written of them; results of another version are made anew.
constexpr int k_batch_version = 1;
/// To Slurm.
constexpr std::chrono::seconds k_between_questions{5};

struct BatchCommand {
    CommonOptions common;
    fs::path source, model, models, out;
    fs::path cache = default_feature_folder();
    double memory = 0;
    std::size_t group = 8, tasks = 0;
    bool gltf = false, keep_small = false, retry = false;
    bool slurm = false, wait = false;
    SlurmOptions slurm_options;
};

/// Names what the results depend on, but for the shapes.
std::string run_key(const BatchModels& models, bool gltf, bool keep_small) {
    const std::string key = fmt::format("{} features {} batch {} gltf {} small {}", models.key(), k_feature_version,
                                        k_batch_version, gltf, keep_small);
    return fmt::format("{:016x}", XXH3_64bits(key.data(), key.size()));
}

std::string describe_models(const BatchModels& models) {
    if (models.models.size() == 1 && !models.recognizer) return "the model " + models.models.front().name;
    return counted(models.models.size(), "model") + (models.recognizer ? " and a recognizer" : "");
}

BatchModels load_models(const fs::path& path, bool keep_small) {
    require_input(path);
    if (!fs::is_directory(path)) model_of_argument(path);  // says best what is no model
    BatchModels models = load_batch_models(path);
    if (keep_small)
        for (BatchModel& model : models.models) model.model.crf.merge_fraction = 0;
    return models;
}

fs::path whole(const fs::path& path) {
    return fs::absolute(path).lexically_normal();
}

AddOptions add_options(const BatchCommand& options) {
    AddOptions add;
    add.named_after_source = false;
    add.memory = memory_of_option(options.memory);
    add.quiet = options.common.quiet;
    return add;
}

/// The catalog that was given, or one in the output folder of the meshes that were.
Catalog open_catalog(const BatchCommand& options) {
    if (is_database(options.source)) return {options.source, Database::Open::existing};
    Catalog catalog(options.out / "catalog.db", Database::Open::create);
    add_to_catalog(catalog, {options.source}, add_options(options));
    return catalog;
}

/// What is written is no shape; an output folder that holds the shapes would hide them.
void prepare_output(const BatchCommand& options) {
    require_output_folder(options.out);
    if (fs::is_directory(options.source) && fs::weakly_canonical(options.out) == fs::weakly_canonical(options.source))
        throw UsageError(
            fmt::format("{}: is the folder of the shapes; give another folder to write to", options.out.string()));
    refuse_links(options.out);
    write_file_atomically(options.out / k_output_mark, [](std::ostream&) {});
}

std::size_t most_memory(const BatchCommand& options) {
    return options.memory > 0 ? memory_of_option(options.memory) : usable_memory() / 2;
}

BatchOptions batch_options(const BatchCommand& options) {
    return {.cache = usable_cache(options.cache, options.common.quiet),
            .memory = most_memory(options),
            .group = options.group};
}

void report(const BatchCommand& options, const BatchResult& result, const DeviceBackend& backend, Json more) {
    if (!options.common.quiet) print_result(result);
    Json json = describe(result);
    json.update(more);
    json["device"] = backend.device_name();
    json["memory"] = 1e-9 * static_cast<double>(most_memory(options));
    write_report(options.common, json);
}

/// Labels what is left of a run, beside other programs that do so.
void run_here(const BatchCommand& options, Catalog& catalog, CatalogRun& run, const BatchPlan& plan,
              const BatchModels& models) {
    DeviceBackend backend(options.common.device);
    const WorkerFolder worker(plan.out);
    CatalogWork work(catalog, run, plan.out, worker.id());
    const BatchWriter writer(run.folder(), worker, run.key(), plan.gltf);
    const BatchResult result = run_work(work, writer, models, backend, batch_options(options));
    write_batch_page(plan.out / "index.html", catalog, run,
                     {result.stages, result.counts.all() - result.counts.taken_over, result.wall});
    const std::int64_t unusable = catalog.count("problem <> ''");
    report(options, result, backend, {{"run", run.id()}, {"unusable", unusable}});
    if (unusable > 0 && !options.common.quiet)
        fmt::print("{} cannot be used ('exemplar catalog list {} --problems' says why)\n",
                   counted(static_cast<std::size_t>(unusable), "shape"), shell_word(catalog.database().name()));
}

/// What a task is told of how to work; empty values are left to it.
std::vector<std::string> task_arguments(const BatchCommand& options) {
    std::vector<std::string> words{"--quiet", "--group", std::to_string(options.group)};
    const auto add = [&](const char* option, const std::string& value) { words.insert(words.end(), {option, value}); };
    add("--cache", options.cache.empty() ? "" : whole(options.cache).string());
    if (!options.common.device.empty()) add("--device", options.common.device);
    if (options.common.threads) add("--threads", std::to_string(options.common.threads));
    if (options.memory > 0) add("--memory", fmt::format("{}", options.memory));
    return words;
}

void print_how_to_run(const std::vector<fs::path>& shards, const std::vector<std::string>& arguments) {
    std::string words;
    for (const std::string& argument : arguments) words += ' ' + shell_word(argument);
    const std::string folder = shell_word(shards.front().parent_path().string());
    const std::string program = shell_word(this_program().string());
    fmt::print("run them anywhere that sees the same files, in any order, one at a time on a machine, say by\n");
    fmt::print("    for shard in {}/*.shard; do {} label batch \"$shard\"{}; done\n", folder, program, words);
    // -q: GNU parallel has a shell read the words once more
    fmt::print("    parallel -q -j1 {} label batch {{}}{} ::: {}/*.shard\n", program, words, folder);
}

std::size_t shapes_left(CatalogRun& run) {
    const CatalogRun::Counts counts = run.counts();
    return static_cast<std::size_t>(counts.open + counts.claimed);
}

std::size_t take_results_over(CatalogRun& run) {
    return run.merge_records([](std::size_t) {});
}

void sleep_interruptibly(std::chrono::seconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) {
        check_interrupt();
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

/// Takes results over until no task is left. Returns Slurm's problem if it has not answered for long, else nothing.
std::string wait_for_tasks(CatalogRun& run, const SlurmJob& job, Progress& progress) {
    constexpr double k_patience = 600;  // s: longer than slurmctld takes to start again
    Stopwatch since_answer, since_pass;
    double pass = 0;  // s that it took
    for (;;) {
        sleep_interruptibly(k_between_questions);
        const SlurmAnswer answer = ask_for_job(job);
        // a look for each record costs a file server something
        if (answer.job == SlurmAnswer::Job::ended || since_pass.wall() > 10 * pass) {
            const Stopwatch watch;
            progress.advance(take_results_over(run));
            pass = watch.wall();
            since_pass = Stopwatch();
        }
        if (answer.job == SlurmAnswer::Job::ended) return {};
        if (answer.job == SlurmAnswer::Job::alive) since_answer = Stopwatch();
        if (since_answer.wall() > k_patience) return answer.problem;
    }
}

/// Waits for the tasks of a job and takes their results over. Returns what is wrong if shapes are left, else nothing.
std::string wait_for_job(CatalogRun& run, const SlurmJob& job, const fs::path& folder, const std::string& merge) {
    Progress progress("labeling on the cluster", shapes_left(run));
    const std::string problem = wait_for_tasks(run, job, progress);
    if (!problem.empty())
        return fmt::format("Slurm does not answer ({}); job {} goes on, and '{}' takes its results over", problem,
                           job.number, merge);
    // Network file systems remember for up to half a minute that there was no such file.
    for (int i = 0; i < 6 && shapes_left(run) > 0; ++i) {
        sleep_interruptibly(k_between_questions);
        progress.advance(take_results_over(run));
    }
    progress.finish();
    const std::size_t left = shapes_left(run);
    if (left == 0) return {};
    return fmt::format(
        "all tasks of job {} have ended and {} left to label; {}/{}_*.log say why, and the same command "
        "again does what is left",
        job.number, left == 1 ? "1 shape is" : counted(left, "shape") + " are", folder.string(), job.number);
}

/// The page and the report of a run whose shapes are labeled elsewhere.
void report_elsewhere(const BatchCommand& options, Catalog& catalog, CatalogRun& run, const BatchPlan& plan,
                      Json json) {
    const CatalogRun::Counts counts = run.counts();
    if (options.wait || json["shards"].empty()) {
        write_batch_page(plan.out / "index.html", catalog, run, {});
        fmt::print("{} labeled, {} of unknown category, {} failed, {} to do\n",
                   counted(static_cast<std::size_t>(counts.done), "shape"), counts.unknown, counts.failed,
                   counts.open + counts.claimed);
    }
    json["labeled"] = counts.done;
    json["unknown"] = counts.unknown;
    json["failed"] = counts.failed;
    json["open"] = counts.open + counts.claimed;
    write_report(options.common, json);
}

/// Leaves the work to tasks, of Slurm or by hand.
void run_elsewhere(const BatchCommand& options, Catalog& catalog, CatalogRun& run, const BatchPlan& plan) {
    take_results_over(run);
    const std::vector<fs::path> shards = write_shards(run, plan, options.tasks);
    const std::string merge = fmt::format("exemplar catalog merge {}", shell_word(catalog.database().name()));
    Json json{{"run", run.id()}, {"shards", Json::array()}, {"job", nullptr}};
    for (const fs::path& shard : shards) json["shards"].push_back(shard.string());
    std::string problem;
    if (shards.empty()) {
        fmt::print("nothing is left to label\n");
    } else {
        const fs::path folder = shards.front().parent_path();
        const std::vector<std::string> arguments = task_arguments(options);
        fmt::print("{} in {}\n", counted(shards.size(), "shard"), folder.string());
        if (options.slurm) {
            const SlurmJob job = submit_shards(shards, options.slurm_options, arguments);
            json["job"] = job.number;
            fmt::print("submitted as job {}\n", job.number);
            std::fflush(stdout);
            if (options.wait) problem = wait_for_job(run, job, folder, merge);
        } else {
            print_how_to_run(shards, arguments);
        }
        if (!options.wait) fmt::print("then take the results over with\n    {}\n", merge);
    }
    report_elsewhere(options, catalog, run, plan, json);
    if (!problem.empty()) throw DataError(problem);
}

/// Slurm gives a task less than the machine has.
void heed_slurm(BatchCommand& options) {
    if (options.common.threads == 0) options.common.threads = number_of_task("SLURM_CPUS_PER_TASK");
    if (options.common.threads == 0) options.common.threads = number_of_task("SLURM_CPUS_ON_NODE");
    if (options.memory == 0) options.memory = 0.5e-9 * static_cast<double>(std::min(memory_of_task(), usable_memory()));
}

void run_shard(BatchCommand options) {
    heed_slurm(options);
    const auto limits = apply_common_options(options.common);
    Shard shard = read_shard(options.source);
    const BatchPlan plan = shard.plan;
    const BatchModels models = load_models(plan.models, plan.keep_small);
    if (run_key(models, plan.gltf, plan.keep_small) != plan.key)
        throw ModelError(
            fmt::format("{}: the models in {} are not those that the shard was written for; write the shards "
                        "again",
                        options.source.string(), plan.models.string()));
    require_output_folder(plan.out);
    refuse_links(plan.out);
    if (!fs::exists(plan.out / k_output_mark))
        throw DataError(fmt::format("{}: its output folder {} was not made by the program; write the shards again",
                                    options.source.string(), plan.out.string()));
    DeviceBackend backend(options.common.device);
    const WorkerFolder worker(plan.out);
    ShardWork work(std::move(shard), number_of_task("SLURM_RESTART_COUNT") % 2 == 1);
    const BatchWriter writer(plan.out / "labeled", worker, plan.key, plan.gltf);
    report(options, run_work(work, writer, models, backend, batch_options(options)), backend,
           {{"shard", options.source.string()}});
}

void check_usage(const BatchCommand& options) {
    if (options.model.empty() == options.models.empty())
        throw UsageError("give either --model FILE or --models FOLDER");
    if (options.slurm && options.tasks == 0) throw UsageError("--slurm wants to know how many --tasks N");
    if (options.wait && !options.slurm) throw UsageError("--wait waits for tasks of --slurm");
}

void run_batch(const BatchCommand& options) {
    keep_freed_memory();  // each shape wants as much as the one before
    require_input(options.source);
    if (is_shard(options.source)) return run_shard(options);
    const auto limits = apply_common_options(options.common);
    check_usage(options);
    const fs::path& source_of_models = options.model.empty() ? options.models : options.model;
    const BatchModels models = load_models(source_of_models, options.keep_small);
    prepare_output(options);
    const BatchPlan plan{.models = whole(source_of_models),
                         .out = whole(options.out),
                         .key = run_key(models, options.gltf, options.keep_small),
                         .gltf = options.gltf,
                         .keep_small = options.keep_small};
    Catalog catalog = open_catalog(options);
    CatalogRun run(catalog, plan.key, plan.out / "labeled", describe_models(models));
    if (options.retry) {
        look_at_unusable(catalog, add_options(options));
        run.merge_records([](std::size_t) {});  // what tasks could not do is tried again as well
    }
    reopen_shapes(run, options.retry);
    if (options.tasks > 0) return run_elsewhere(options, catalog, run, plan);
    run_here(options, catalog, run, plan, models);
}

void add_slurm_options(CLI::App& command, BatchCommand& options) {
    command
        .add_option("--tasks", options.tasks, "divide the shapes among so many tasks, to be run by --slurm or by hand")
        ->check(whole_number(1, 100'000))
        ->type_name("N");
    CLI::Option* slurm = command.add_flag("--slurm", options.slurm, "submit the tasks to Slurm, as a job array");
    command.add_flag("--wait", options.wait, "wait until the tasks have ended, and take their results over");
    SlurmOptions& cluster = options.slurm_options;
    const auto add = [&](const char* name, auto& value, const char* what) {
        return command.add_option(name, value, what)->needs(slurm);
    };
    add("--partition", cluster.partition, "partition of the cluster")->type_name("NAME");
    add("--gres", cluster.gres, "what each task needs, say gpu:1")->type_name("LIST");
    add("--time", cluster.time, "longest time of each task, say 4:00:00")->type_name("TIME");
    add("--cpus-per-task", cluster.cpus, "processors of each task")->check(whole_number(1, 4096))->type_name("N");
    add("--mem", cluster.memory, "memory of each task, GB")->check(CLI::Range(0.1, 1e6))->type_name("GB");
    add("--sbatch", cluster.further, "a further option of sbatch, as in --sbatch=--account=lab; may be repeated")
        ->allow_extra_args(false)
        ->type_name("OPTION");
}

}  // namespace

void add_batch_command(CLI::App& label) {
    auto options = std::make_shared<BatchCommand>();
    CLI::App* command = label.add_subcommand("batch", "Labels all shapes of a catalog or folder");
    command->footer(
        "Ended at any moment, it goes on where it was when called again. Several calls at once share the work.\n"
        "A shape that cannot be labeled is left out, and the catalog says why.\n\nExample:\n"
        "  exemplar label batch downloads --model chair.safetensors --out labeled\n"
        "  exemplar label batch shapes.db --models models --out labeled\n"
        "  exemplar label batch shapes.db --models models --out labeled --slurm --tasks 100 --gres gpu:1 --wait");
    command
        ->add_option(
            "SOURCE", options->source,
            "catalog of 'exemplar catalog add', a folder of meshes (with those below), a list, a mesh, or a shard")
        ->required()
        ->type_name("");
    command->add_option("--model", options->model, "the model that labels all of them")->type_name("FILE");
    command
        ->add_option("--models", options->models,
                     "folder of models, each named after the category it labels, and one that recognizes categories")
        ->type_name("FOLDER");
    command->add_option("--out", options->out, "folder to write to")->type_name("FOLDER");
    command->add_flag("--gltf", options->gltf, "also write NAME.glb with a material per part");
    command->add_flag("--keep-small", options->keep_small,
                      "leave pieces that are much smaller than any in training as they are, instead of merging them");
    command->add_flag("--retry", options->retry, "try those again that were unusable, failed, or of unknown category");
    command->add_option("--group", options->group, "meshes per submission to the device at most")
        ->capture_default_str()
        ->check(whole_number(1, 1000));
    command->add_option("--cache", options->cache, "folder that remembers features; '' remembers none")
        ->capture_default_str()
        ->type_name("FOLDER");
    add_memory_option(*command, options->memory);
    add_slurm_options(*command, *options);
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_batch(*options); });
}

}  // namespace exemplar
