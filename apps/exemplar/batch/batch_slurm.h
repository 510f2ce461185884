#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace exemplar {

/// What Slurm is to give each task; what is empty or 0 is left to the cluster.
struct SlurmOptions {
    std::string partition, gres, time;
    std::size_t cpus = 0;              ///< per task
    double memory = 0;                 ///< GB per task
    std::vector<std::string> further;  ///< options of sbatch, as they are
};

/// A job that was submitted.
struct SlurmJob {
    std::string number;
    std::string cluster;  ///< where it is if the site has several; else empty
};

/// What Slurm says of a job; nothing where it does not answer.
struct SlurmAnswer {
    enum class Job { alive, ended, unknown };
    Job job;
    std::string problem;  ///< why it is unknown
};

/// Submits an array of tasks, one per shard (all in one folder, 1.shard, 2.shard, ...), each of which runs `exemplar
/// label batch SHARD` with `arguments`, and is run again elsewhere if its node fails. The script and the logs are in
/// the folder of the shards, and so is, once it is submitted, what job it is. Throws DataError with what sbatch says.
SlurmJob submit_shards(std::span<const std::filesystem::path> shards, const SlurmOptions& options,
                       std::span<const std::string> arguments, const std::string& run);

/// Whether tasks of a job wait or run. Slurm forgets jobs some minutes after their end: one that it does not know has
/// ended.
SlurmAnswer ask_for_job(const SlurmJob& job);
/// The jobs that were submitted for shards of this run below OUT/shards, and have not ended as far as Slurm tells.
std::vector<SlurmJob> jobs_at_work(const std::filesystem::path& out, const std::string& run);

/// A number that Slurm tells its tasks by a variable; 0 if it does not.
std::size_t number_of_task(const char* name);
/// Bytes of memory that Slurm gives the task that runs here: what the job asked for or, if it asked for none, the share
/// of the machine that its processors are. 0 if Slurm says neither, or gives all of the machine.
std::size_t memory_of_task();

/// A text as one word of a shell.
std::string shell_word(const std::string& text);
/// This program, by its whole path.
std::filesystem::path this_program();

}  // namespace exemplar
