#include "apps/exemplar/batch/batch_tasks.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "apps/exemplar/batch/batch_shards.h"
#include "apps/exemplar/catalog/batch_page.h"
#include "apps/exemplar/run_words.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::chrono::seconds k_poll_interval{5};  // to Slurm

/// Returns the arguments of a task. Options without a value are left to its defaults.
std::vector<std::string> task_arguments(const BatchCommand& options) {
    std::vector<std::string> words{"--quiet", "--group", std::to_string(options.group)};
    const auto add = [&](const char* option, const std::string& value) { words.insert(words.end(), {option, value}); };
    add("--cache", options.cache.empty() ? "" : whole_path(options.cache).string());
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
    // -q: quotes the words, as GNU parallel passes them through a shell again
    fmt::print("    parallel -q -j1 {} label batch {{}}{} ::: {}/*.shard\n", program, words, folder);
}

std::size_t shapes_left(CatalogRun& run) {
    const CatalogRun::Counts counts = run.counts();
    return static_cast<std::size_t>(counts.open + counts.claimed);
}

std::size_t merge_results(CatalogRun& run) {
    return run.merge_records([](std::size_t) {});
}

void sleep_interruptibly(std::chrono::seconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) {
        check_interrupt();
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

/// Merges results until no task is left. Returns Slurm's problem if it does not answer for long, else nothing.
std::string wait_for_tasks(CatalogRun& run, const SlurmJob& job, Progress& progress) {
    constexpr double k_patience = 600;  // s: longer than slurmctld takes to start again
    Stopwatch since_answer, since_pass;
    double pass = 0;  // s that it took
    for (;;) {
        sleep_interruptibly(k_poll_interval);
        const SlurmStatus answer = query_job(job);
        // looking for every record is a load on a file server
        if (answer.job == SlurmStatus::Job::ended || since_pass.wall() > 10 * pass) {
            const Stopwatch watch;
            progress.advance(merge_results(run));
            pass = watch.wall();
            since_pass = Stopwatch();
        }
        if (answer.job == SlurmStatus::Job::ended) return {};
        if (answer.job == SlurmStatus::Job::alive) since_answer = Stopwatch();
        if (since_answer.wall() > k_patience) return answer.problem;
    }
}

/// Returns the command that ends a job.
std::string scancel(const SlurmJob& job) {
    return fmt::format("'scancel {}{}'", job.number, job.cluster.empty() ? "" : " --clusters=" + job.cluster);
}

/// Waits for the tasks of a job and merges their results. Returns Slurm's problem if it does not answer, else
/// nothing.
std::string wait_for_job(CatalogRun& run, const SlurmJob& job, const std::string& merge) {
    Progress progress("labeling on the cluster", shapes_left(run));
    const std::string problem = wait_for_tasks(run, job, progress);
    if (!problem.empty())
        return fmt::format("Slurm does not answer ({}); job {} goes on, and '{}' takes its results over", problem,
                           job.number, merge);
    // Network file systems may not see a new file for up to half a minute.
    for (int i = 0; i < 6 && shapes_left(run) > 0; ++i) {
        sleep_interruptibly(k_poll_interval);
        progress.advance(merge_results(run));
    }
    progress.finish();
    return {};
}

/// The same; Ctrl-C ends only the waiting, not the job.
std::string wait_unless_interrupted(CatalogRun& run, const SlurmJob& job, const std::string& merge) {
    try {
        return wait_for_job(run, job, merge);
    } catch (const Interrupted&) {
        fmt::print(stderr, "job {} goes on: the same command waits for it again, {} ends it\n", job.number,
                   scancel(job));
        throw;
    }
}

/// Waits for running jobs of earlier calls, as new tasks would only repeat their work.
void wait_for_earlier_jobs(const BatchCommand& options, CatalogRun& run, const BatchPlan& plan,
                           const std::string& merge) {
    for (const SlurmJob& job : running_jobs(plan.out, plan.key)) {
        if (!options.wait)
            throw DataError(fmt::format(
                "job {} of an earlier call is still at work on these shapes; --wait waits for it, {} ends it",
                job.number, scancel(job)));
        if (!options.common.quiet) fmt::print("job {} of an earlier call is still at work\n", job.number);
        std::fflush(stdout);
        const std::string problem = wait_unless_interrupted(run, job, merge);
        if (!problem.empty()) throw DataError(problem);
    }
}

/// Returns a message if shapes are left after all tasks of a job have ended, else nothing.
std::string unfinished_message(CatalogRun& run, const SlurmJob& job, const fs::path& folder) {
    const std::size_t left = shapes_left(run);
    if (left == 0) return {};
    return fmt::format(
        "all tasks of job {} have ended and {} left to label; {}/{}_*.log say why, and the same command "
        "again does what is left",
        job.number, left == 1 ? "1 shape is" : counted(left, "shape") + " are", folder.string(), job.number);
}

/// Writes the page and the report of a run whose shapes are labeled by tasks.
void report_tasks(const BatchCommand& options, Catalog& catalog, CatalogRun& run, const BatchPlan& plan, Json json) {
    const CatalogRun::Counts counts = run.counts();
    if (options.wait || json["shards"].empty()) {
        write_batch_page(plan.out, catalog, run, {});
        if (!options.common.quiet)
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

/// Submits shards and, with --wait, waits for their tasks. Returns a message on what went wrong, or nothing.
std::string run_on_slurm(const BatchCommand& options, CatalogRun& run, const std::vector<fs::path>& shards,
                         const std::string& merge, Json& report) {
    const SlurmJob job = submit_shards(shards, options.slurm_options, task_arguments(options), run.key());
    report["job"] = job.number;
    if (!options.common.quiet) fmt::print("submitted as job {}\n", job.number);
    std::fflush(stdout);
    if (!options.wait) return {};
    const std::string problem = wait_unless_interrupted(run, job, merge);
    return problem.empty() ? unfinished_message(run, job, shards.front().parent_path()) : problem;
}

}  // namespace

void run_as_tasks(const BatchCommand& options, Catalog& catalog, CatalogRun& run, const BatchPlan& plan) {
    const std::string merge = fmt::format("exemplar catalog merge {}", shell_word(catalog.database().name()));
    merge_results(run);
    if (options.slurm) wait_for_earlier_jobs(options, run, plan, merge);
    const std::vector<fs::path> shards = write_shards(run, plan, options.tasks);
    Json json{{"run", run.id()}, {"shards", Json::array()}, {"job", nullptr}};
    for (const fs::path& shard : shards) json["shards"].push_back(shard.string());
    const bool says = !options.common.quiet;
    std::string problem;
    if (shards.empty()) {
        if (says) fmt::print("nothing is left to label\n");
    } else {
        if (says) fmt::print("{} in {}\n", counted(shards.size(), "shard"), shards.front().parent_path().string());
        if (options.slurm) problem = run_on_slurm(options, run, shards, merge, json);
        if (!options.slurm && says) print_how_to_run(shards, task_arguments(options));
        if (!options.wait && says) fmt::print("then take the results over with\n    {}\n", merge);
    }
    report_tasks(options, catalog, run, plan, json);
    if (!problem.empty()) throw DataError(problem);
}

}  // namespace exemplar
