#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace exemplar {

/// Resources of each Slurm task; those that are empty or 0 are left to the cluster.
struct SlurmOptions {
    std::string partition, gres, time;
    std::size_t cpus = 0;              ///< per task
    double memory = 0;                 ///< GB per task
    std::vector<std::string> further;  ///< more options of sbatch, passed as they are
};

/// A job that was submitted.
struct SlurmJob {
    std::string number;
    std::string cluster;  ///< its cluster if the site has several; else empty
};

/// Slurm's answer on the state of a job.
struct SlurmStatus {
    enum class Job { alive, ended, unknown };
    Job job;
    std::string problem;  ///< why the state is unknown
};

/// Submits an array of tasks, one per shard (1.shard, 2.shard, ... in one folder). Each runs `exemplar label batch
/// SHARD` with `arguments`, and is rerun on another node if its node fails. Writes the script, the logs and then the
/// number of the job into the folder of the shards. Throws DataError with the message of sbatch.
SlurmJob submit_shards(std::span<const std::filesystem::path> shards, const SlurmOptions& options,
                       std::span<const std::string> arguments, const std::string& run);

/// Asks Slurm whether tasks of a job are waiting or running. Slurm forgets jobs some minutes after their end, so an
/// unknown job has ended.
SlurmStatus query_job(const SlurmJob& job);
/// Returns the jobs that were submitted for shards of this run below OUT/shards and that Slurm does not report as
/// ended.
std::vector<SlurmJob> running_jobs(const std::filesystem::path& out, const std::string& run);

/// Returns the number in one of Slurm's environment variables; 0 if it is not set.
std::size_t slurm_number(const char* name);
/// Returns the bytes of memory of the running Slurm task: those that the job asked for, else the machine's memory in
/// proportion to the task's processors. 0 if Slurm tells neither, or the task has the whole machine.
std::size_t slurm_task_memory();

/// Quotes a text as one word of a shell.
std::string shell_word(const std::string& text);

}  // namespace exemplar
