#include "apps/exemplar/batch/batch_slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <sstream>
#include <string_view>

#include "apps/exemplar/commands.h"
#include "apps/exemplar/run_words.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/memory_budget.h"
#include "host/data/catalog/shape_record.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

/// Escapes '%', which Slurm replaces by numbers in file names.
std::string slurm_pattern(const fs::path& path) {
    std::string text;
    for (const char c : path.string()) text += c == '%' ? std::string("%%") : std::string(1, c);
    return text;
}

std::string script_for(const fs::path& folder, std::span<const std::string> arguments) {
    std::string words;
    for (const std::string& argument : arguments) words += ' ' + shell_word(argument);
    return fmt::format(
        "#!/bin/sh\n"
        "# One task of a batch labeling: the shard of its number. Two copies of a task may run at once and do no "
        "harm.\n"
        "# exec: signals reach the program.\n"
        "exec {} label batch {}/\"$SLURM_ARRAY_TASK_ID\".shard{}\n",
        shell_word(this_program().string()), shell_word(folder.string()), words);
}

std::vector<std::string> sbatch_words(const fs::path& folder, std::size_t tasks, const SlurmOptions& options) {
    std::vector<std::string> words{"sbatch",
                                   "--parsable",
                                   "--job-name=exemplar-label",
                                   fmt::format("--array=1-{}", tasks),
                                   "--requeue",
                                   "--open-mode=append",
                                   "--output=" + slurm_pattern(folder) + "/%A_%a.log",
                                   "--chdir=" + folder.string()};
    if (!options.partition.empty()) words.push_back("--partition=" + options.partition);
    if (!options.gres.empty()) words.push_back("--gres=" + options.gres);
    if (!options.time.empty()) words.push_back("--time=" + options.time);
    if (options.cpus) words.push_back(fmt::format("--cpus-per-task={}", options.cpus));
    if (options.memory > 0) words.push_back(fmt::format("--mem={:.0f}M", 1000 * options.memory));
    words.insert(words.end(), options.further.begin(), options.further.end());
    words.push_back((folder / "task.sh").string());
    return words;
}

/// File in the folder of the shards that names their job.
constexpr const char* k_job_file = "job.json";

/// The job of a folder of shards; nothing if there is none, or it is another run's.
std::optional<SlurmJob> job_in_queue(const fs::path& shards, const std::string& run) {
    std::error_code ignored;
    if (!fs::exists(shards / k_job_file, ignored)) return {};
    const nlohmann::json json = parse_shallow(read_file(shards / k_job_file));
    const auto word = [&](const char* key) {
        const bool is_there = json.is_object() && json.contains(key) && json[key].is_string();
        return is_there ? json[key].get<std::string>() : std::string();
    };
    if (word("run") != run || word("job").empty()) return {};
    return SlurmJob{word("job"), word("cluster")};
}

/// Returns whether squeue's answer has a task that has not ended. Other lines are the name of each cluster, and
/// remarks.
bool has_active_task(const std::string& answer) {
    constexpr std::array<std::string_view, 10> k_ended{"BOOT_FAIL", "CANCELLED", "COMPLETED", "DEADLINE",
                                                       "FAILED",    "NODE_FAIL", "TIMEOUT",   "OUT_OF_MEMORY",
                                                       "PREEMPTED", "REVOKED"};
    const auto is_state = [](const std::string& line) {
        return !line.empty() && std::ranges::all_of(line, [](char c) { return (c >= 'A' && c <= 'Z') || c == '_'; });
    };
    std::istringstream lines(answer);
    for (std::string line; std::getline(lines, line);)
        if (is_state(line) && std::ranges::find(k_ended, line) == k_ended.end()) return true;
    return false;
}

}  // namespace

std::string shell_word(const std::string& text) {
    const auto plain = [](unsigned char c) { return std::isalnum(c) || std::strchr("_-./=:,+@", c); };
    bool is_plain = !text.empty();
    std::string quoted = "'";
    for (const char c : text) {
        is_plain = is_plain && c != '\0' && plain(static_cast<unsigned char>(c));
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return is_plain ? text : quoted + "'";
}

SlurmJob submit_shards(std::span<const fs::path> shards, const SlurmOptions& options,
                       std::span<const std::string> arguments, const std::string& run) {
    const fs::path folder = shards.front().parent_path();
    write_file_atomically(folder / "task.sh", [&](std::ostream& out) { out << script_for(folder, arguments); });
    const std::vector<std::string> words = sbatch_words(folder, shards.size(), options);
    write_file_atomically(folder / "submit.sh", [&](std::ostream& out) {
        out << "#!/bin/sh\n# How the tasks were submitted; once more, it does what is left.\nexec";
        for (const std::string& word : words) out << ' ' << shell_word(word);
        out << '\n';
    });
    const ProgramOutput output = run_words(words);
    if (output.code == 127)
        throw DataError(
            "sbatch cannot be run (" + output.text +
            "); Slurm's client is missing here (Debian: slurm-client). Without --slurm shards are only written");
    if (output.code != 0) throw DataError("sbatch refused the job: " + first_line(output.text));
    // the last line is "JOB" or "JOB;CLUSTER"; messages of the site may precede it
    std::string last = output.text.substr(0, output.text.find_last_not_of('\n') + 1);
    last = last.substr(last.rfind('\n') + 1);
    const std::size_t end = std::min(last.find(';'), last.size());
    SlurmJob job{.number = last.substr(0, end), .cluster = last.substr(std::min(end + 1, last.size()))};
    write_json(folder / k_job_file, {{"job", job.number}, {"cluster", job.cluster}, {"run", run}});
    return job;
}

SlurmStatus query_job(const SlurmJob& job) {
    // all states, as tasks that a user's SQUEUE_STATES leaves out would seem to have ended
    std::vector<std::string> words{"squeue", "--noheader", "--states=all", "--format=%T", "--jobs=" + job.number};
    if (!job.cluster.empty()) words.push_back("--clusters=" + job.cluster);
    const ProgramOutput output = run_words(words);
    if (output.code != 0 && output.text.find("Invalid job id") != std::string::npos)
        return {SlurmStatus::Job::ended, {}};
    if (output.code != 0) return {SlurmStatus::Job::unknown, "squeue: " + first_line(output.text)};
    return {has_active_task(output.text) ? SlurmStatus::Job::alive : SlurmStatus::Job::ended, {}};
}

std::vector<SlurmJob> running_jobs(const fs::path& out, const std::string& run) {
    std::vector<SlurmJob> jobs;
    std::error_code error;
    for (fs::directory_iterator it(out / "shards", error), end; !error && it != end; it.increment(error)) {
        const std::optional<SlurmJob> job = job_in_queue(it->path(), run);
        if (!job) continue;
        if (query_job(*job).job == SlurmStatus::Job::ended)
            fs::remove(it->path() / k_job_file, error);  // it need not be asked for again
        else
            jobs.push_back(*job);
    }
    return jobs;
}

std::size_t slurm_number(const char* name) {
    const char* const text = std::getenv(name);
    return text ? static_cast<std::size_t>(std::strtoull(text, nullptr, 10)) : 0;
}

std::size_t slurm_task_memory() {
    constexpr std::size_t k_megabyte = 1'000'000;
    const std::size_t processors = slurm_number("SLURM_CPUS_ON_NODE");
    if (std::getenv("SLURM_MEM_PER_NODE")) return k_megabyte * slurm_number("SLURM_MEM_PER_NODE");
    if (std::getenv("SLURM_MEM_PER_CPU")) return k_megabyte * slurm_number("SLURM_MEM_PER_CPU") * processors;
    const auto all = static_cast<std::size_t>(std::max(sysconf(_SC_NPROCESSORS_ONLN), 1L));
    return processors < all ? usable_memory() / all * processors : 0;
}

}  // namespace exemplar
