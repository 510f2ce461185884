#pragma once

#include <filesystem>
#include <string>

namespace exemplar {

/// A lock on a file that the system gives free when its holder ends, however it ends.
class FileLock {
  public:
    /// Waits for the lock; makes the file if there is none. Throws DataError.
    explicit FileLock(const std::filesystem::path& path);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    int file_;
};

/// Where one process prepares the files that it then moves into an output folder: OUT/.work/ID, beside a lock
/// OUT/.work/ ID.lock that tells whether the process is alive. What a process that was killed has left is removed by
/// the next on the same machine, or after a day on any: locks do not reach from machine to machine everywhere.
class WorkerFolder {
  public:
    /// Makes a folder for this process, and removes those of dead ones. Throws DataError.
    explicit WorkerFolder(const std::filesystem::path& output);
    ~WorkerFolder();
    WorkerFolder(const WorkerFolder&) = delete;
    WorkerFolder& operator=(const WorkerFolder&) = delete;

    /// Names this process among all of all machines.
    const std::string& id() const { return id_; }
    const std::filesystem::path& path() const { return path_; }

    /// Whether the worker of that name is alive, or may be: where the system cannot tell. Where locks do not reach
    /// other machines, a worker there seems dead; then a shape may be labeled twice, and the first result counts.
    static bool may_be_alive(const std::filesystem::path& output, const std::string& id);

  private:
    std::string id_;
    std::filesystem::path path_, lock_path_;
    int lock_ = -1;
};

/// Throws DataError if what a batch run writes to directly in its output folder is a link.
void refuse_links(const std::filesystem::path& output);

/// The folder of OUT in which the files of `name` (see is_output_name) belong, made if need be. Throws DataError if
/// a part of it is a link or no folder: nothing is written outside OUT.
std::filesystem::path make_output_folder(const std::filesystem::path& output, const std::string& name);

/// The name of an empty file in folders that batch labeling writes to: they hold no shapes to label.
constexpr const char* k_output_mark = ".exemplar-output";
/// Makes that file if there is none. Throws DataError.
void mark_output_folder(const std::filesystem::path& output);

}  // namespace exemplar
