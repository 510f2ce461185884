#pragma once

#include <filesystem>
#include <string>

namespace exemplar {

/// A lock on a file that the system releases when its holder ends, however it ends.
class FileLock {
  public:
    /// Waits for the lock; creates the file if there is none. Throws DataError.
    explicit FileLock(const std::filesystem::path& path);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    int file_;
};

/// The folder OUT/.work/ID in which one process prepares files before it moves them into an output folder. A lock
/// OUT/.work/ID.lock beside it shows whether the process is alive. The next process on the same machine removes what
/// a killed one left; after a day any process does, since locks do not reach other machines on every file system.
class WorkerFolder {
  public:
    /// Creates a folder for this process, and removes those of dead ones. Throws DataError.
    explicit WorkerFolder(const std::filesystem::path& output);
    ~WorkerFolder();
    WorkerFolder(const WorkerFolder&) = delete;
    WorkerFolder& operator=(const WorkerFolder&) = delete;

    /// Returns an id that is unique among all processes of all machines.
    const std::string& id() const { return id_; }
    const std::filesystem::path& path() const { return path_; }

    /// Returns whether the worker of that name is alive, or may be where the system cannot tell. On file systems
    /// whose locks do not reach other machines, a worker there seems dead; then a shape may be labeled twice, and
    /// the first result counts.
    static bool may_be_alive(const std::filesystem::path& output, const std::string& id);

  private:
    std::string id_;
    std::filesystem::path path_, lock_path_;
    int lock_ = -1;
};

/// Throws DataError if anything that a batch run writes directly in its output folder is a link.
void refuse_links(const std::filesystem::path& output);

/// Returns the folder in `output` for the files of `name` (see is_output_name), and creates it if need be. Throws
/// DataError if a part of it is a link or no folder, so that nothing is written outside `output`.
std::filesystem::path make_output_folder(const std::filesystem::path& output, const std::string& name);

/// The name of an empty file that marks folders written by batch labeling: they hold no shapes to label.
constexpr const char* k_output_mark = ".exemplar-output";
/// Creates that file if there is none. Throws DataError.
void mark_output_folder(const std::filesystem::path& output);

}  // namespace exemplar
