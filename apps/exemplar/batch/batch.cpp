// exemplar label batch: labels all shapes of a catalog or a folder, overnight if need be.

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <utility>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "apps/exemplar/batch/batch_run.h"
#include "apps/exemplar/batch/batch_shards.h"
#include "apps/exemplar/batch/batch_slurm.h"
#include "apps/exemplar/batch/batch_tasks.h"
#include "apps/exemplar/catalog/batch_page.h"
#include "apps/exemplar/catalog/catalog_add.h"
#include "apps/exemplar/commands.h"
#include "host/core/errors.h"
#include "host/core/freed_memory.h"
#include "host/core/interrupt.h"
#include "host/core/memory_budget.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/labeling/features/feature_cache.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Version of the labeling and of its output; results of another version are made again.
constexpr int k_batch_version = 1;
/// Returns a key of everything that the results depend on except the shapes.
std::string batch_run_key(const BatchModels& models, bool gltf, bool keep_small) {
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
    if (!fs::is_directory(path)) model_of_argument(path);  // has the best error message
    BatchModels models = load_batch_models(path);
    if (keep_small)
        for (BatchModel& model : models.models) model.model.crf.merge_fraction = 0;
    return models;
}

AddOptions add_options(const BatchCommand& options) {
    AddOptions add;
    add.named_after_source = false;
    add.memory = memory_of_option(options.memory);
    add.quiet = options.common.quiet;
    return add;
}

/// Opens the given catalog, or makes one of the given meshes in the output folder.
Catalog open_catalog(const BatchCommand& options) {
    if (is_database(options.source)) return {options.source, Database::Open::existing};
    Catalog catalog(options.out / "catalog.db", Database::Open::create);
    add_to_catalog(catalog, {options.source}, add_options(options));
    return catalog;
}

/// Marks the output folder, so that results in it are not found as shapes. Throws UsageError if it is the shapes'
/// folder.
void prepare_output(const BatchCommand& options) {
    require_output_folder(options.out);
    if (fs::is_directory(options.source) && fs::weakly_canonical(options.out) == fs::weakly_canonical(options.source))
        throw UsageError(
            fmt::format("{}: is the folder of the shapes; give another folder to write to", options.out.string()));
    refuse_links(options.out);
    mark_output_folder(options.out);
}

std::size_t max_memory(const BatchCommand& options) {
    return options.memory > 0 ? memory_of_option(options.memory) : usable_memory() / 2;
}

BatchOptions batch_options(const BatchCommand& options) {
    return {.cache = usable_cache(options.cache, options.common.quiet),
            .memory = max_memory(options),
            .group = options.group};
}

void report_batch(const BatchCommand& options, const BatchResult& result, const DeviceBackend& backend, Json more) {
    if (!options.common.quiet) print_result(result);
    Json json = describe(result);
    json.update(more);
    json["device"] = backend.device_name();
    json["memory"] = 1e-9 * static_cast<double>(max_memory(options));
    write_report(options.common, json);
}

/// Labels the remaining shapes of a run; other programs may do so at the same time.
void run_here(const BatchCommand& options, Catalog& catalog, CatalogRun& run, const BatchPlan& plan,
              const BatchModels& models) {
    DeviceBackend backend(options.common.device);
    const WorkerFolder worker(plan.out);
    CatalogWork work(catalog, run, plan.out, worker.id());
    const BatchWriter writer(run.folder(), worker, run.key(), plan.gltf);
    const BatchResult result = run_work(work, writer, models, backend, batch_options(options));
    write_batch_page(plan.out, catalog, run,
                     {result.stages, result.counts.all() - result.counts.taken_over, result.wall});
    const std::int64_t unusable = catalog.count("problem <> ''");
    report_batch(options, result, backend, {{"run", run.id()}, {"unusable", unusable}});
    if (unusable > 0 && !options.common.quiet)
        fmt::print("{} cannot be used ('exemplar catalog list {} --problems' says why)\n",
                   counted(static_cast<std::size_t>(unusable), "shape"), shell_word(catalog.database().name()));
}

/// Limits threads and memory to those that Slurm gives the task.
void apply_slurm_limits(BatchCommand& options) {
    if (options.common.threads == 0) options.common.threads = slurm_number("SLURM_CPUS_PER_TASK");
    if (options.common.threads == 0) options.common.threads = slurm_number("SLURM_CPUS_ON_NODE");
    if (options.memory == 0)
        options.memory = 0.5e-9 * static_cast<double>(std::min(slurm_task_memory(), usable_memory()));
}

/// Throws UsageError for options that a shard fixes: what is labeled, how and where to.
void check_shard_usage(const BatchCommand& options) {
    for (const auto& [is_given, option] : {std::pair(!options.model.empty(), "--model"),
                                           {!options.models.empty(), "--models"},
                                           {!options.out.empty(), "--out"},
                                           {options.gltf, "--gltf"},
                                           {options.keep_small, "--keep-small"},
                                           {options.retry, "--retry"},
                                           {options.tasks > 0, "--tasks"},
                                           {options.slurm, "--slurm"},
                                           {options.wait, "--wait"}})
        if (is_given)
            throw UsageError(fmt::format("{}: is a shard, whose catalog was given such options; leave out {}",
                                         options.source.string(), option));
}

void run_shard(BatchCommand options) {
    check_shard_usage(options);
    apply_slurm_limits(options);
    const auto limits = apply_common_options(options.common);
    Shard shard = read_shard(options.source);
    const BatchPlan plan = shard.plan;
    const BatchModels models = load_models(plan.models, plan.keep_small);
    if (batch_run_key(models, plan.gltf, plan.keep_small) != plan.key)
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
    ShardWork work(std::move(shard), slurm_number("SLURM_RESTART_COUNT") % 2 == 1);
    const BatchWriter writer(plan.out / "labeled", worker, plan.key, plan.gltf);
    report_batch(options, run_work(work, writer, models, backend, batch_options(options)), backend,
                 {{"shard", options.source.string()}});
}

void check_usage(const BatchCommand& options) {
    if (options.model.empty() == options.models.empty())
        throw UsageError("give either --model FILE or --models FOLDER");
    if (options.slurm && options.tasks == 0) throw UsageError("--slurm wants to know how many --tasks N");
    if (options.wait && !options.slurm) throw UsageError("--wait waits for tasks of --slurm");
}

void run_batch(const BatchCommand& options) {
    keep_freed_memory();  // each shape needs as much as the one before
    require_input(options.source);
    if (is_shard(options.source)) return run_shard(options);
    const auto limits = apply_common_options(options.common);
    check_usage(options);
    const fs::path& source_of_models = options.model.empty() ? options.models : options.model;
    const BatchModels models = load_models(source_of_models, options.keep_small);
    prepare_output(options);
    const BatchPlan plan{.models = whole_path(source_of_models),
                         .out = whole_path(options.out),
                         .key = batch_run_key(models, options.gltf, options.keep_small),
                         .gltf = options.gltf,
                         .keep_small = options.keep_small};
    Catalog catalog = open_catalog(options);
    CatalogRun run(catalog, plan.key, plan.out / "labeled", describe_models(models));
    if (options.retry) {
        retry_unusable(catalog, add_options(options));
        run.merge_records([](std::size_t) {});  // also retries what tasks could not do
    }
    reopen_shapes(run, options.retry);
    if (options.tasks > 0) return run_as_tasks(options, catalog, run, plan);
    run_here(options, catalog, run, plan, models);
}

void add_slurm_options(Command& command, BatchCommand& options) {
    command
        .add_option("--tasks", options.tasks, "divide the shapes among so many tasks, to be run by --slurm or by hand")
        ->check(whole_number(1, 100'000))
        ->type_name("N");
    Option* slurm = command.add_flag("--slurm", options.slurm, "submit the tasks to Slurm, as a job array");
    command.add_flag("--wait", options.wait, "wait until the tasks have ended, and take their results over");
    SlurmOptions& cluster = options.slurm_options;
    const auto add = [&](const char* name, auto& value, const char* what) {
        return command.add_option(name, value, what)->needs(slurm);
    };
    add("--partition", cluster.partition, "partition of the cluster")->type_name("NAME");
    add("--gres", cluster.gres, "what each task needs, say gpu:1")->type_name("LIST");
    add("--time", cluster.time, "longest time of each task, say 4:00:00")->type_name("TIME");
    add("--cpus-per-task", cluster.cpus, "processors of each task")->check(whole_number(1, 4096))->type_name("N");
    add("--mem", cluster.memory, "memory of each task, GB")->check(in_range(0.1, 1e6))->type_name("GB");
    add("--sbatch", cluster.further, "a further option of sbatch, as in --sbatch=--account=lab; may be repeated")
        ->allow_extra_args(false)
        ->type_name("OPTION");
}

}  // namespace

void add_batch_command(Command& label) {
    auto options = std::make_shared<BatchCommand>();
    Command* command = label.add_subcommand("batch", "Labels all shapes of a catalog or folder");
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
