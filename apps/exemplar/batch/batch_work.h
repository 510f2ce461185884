#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "host/data/catalog/catalog_run.h"
#include "host/data/catalog/worker_folder.h"
#include "host/labeling/batch/batch_labeling.h"

namespace exemplar {

/// Outcomes of the shapes of a batch run, or of this program's part of it.
struct BatchCounts {
    std::size_t done = 0, failed = 0, unknown = 0;
    std::size_t taken_over = 0;  ///< of these, results of other programs found in the output folder

    void count(const ShapeRecord& record, bool is_new);
    std::size_t all() const { return done + failed + unknown; }
};

/// The shapes that a program has to label. next() and finish() may be called from two threads.
class BatchWork {
  public:
    virtual ~BatchWork() = default;
    /// Returns the next shape to label, or nothing. Takes over results found in the output folder on the way.
    virtual std::optional<CatalogShape> next() = 0;
    /// Stores the outcome of a shape whose record is in the output folder; `is_new`: this program made the record.
    virtual void finish(const BatchShape& shape, bool is_new) = 0;
    /// Returns the number of shapes to do, as far as it is known.
    virtual std::size_t total() = 0;
    BatchCounts counts() const {
        const std::lock_guard lock(mutex_);
        return counts_;
    }

  protected:
    mutable std::mutex mutex_;
    BatchCounts counts_;
};

/// Removes the record of the shape `name` in a run's folder. Throws DataError if there is a link on the path.
void remove_record(const std::filesystem::path& folder, const std::string& name);
/// Reopens shapes that no longer have a record in the run's folder (somebody has removed it, or another run has
/// replaced it) and, with `retry`, those that failed or were of unknown category.
void reopen_shapes(CatalogRun& run, bool retry);

/// The shapes of a catalog's run that no program has claimed yet.
class CatalogWork final : public BatchWork {
  public:
    /// `output` contains the worker's folder and the run's folder.
    CatalogWork(Catalog& catalog, CatalogRun& run, const std::filesystem::path& output, const std::string& worker);
    /// Releases its claims.
    ~CatalogWork() override;
    std::optional<CatalogShape> next() override;
    void finish(const BatchShape& shape, bool is_new) override;
    std::size_t total() override;

  private:
    void release_dead_claims();
    bool claim_some();
    Catalog& catalog_;
    CatalogRun& run_;
    std::filesystem::path output_;
    std::string worker_;
    std::deque<CatalogShape> claimed_;
    std::int64_t last_ = 0;
    bool again_ = true;  ///< whether shapes before `last_` are to be searched again
};

/// Writes results of shapes into an output folder, each with a record of what was done. The record is written last,
/// so that no reader sees partial results, and by only one of several programs that label the same shape. Once it
/// exists, the other programs do not change the shape's files.
class BatchWriter {
  public:
    BatchWriter(std::filesystem::path folder, const WorkerFolder& worker, std::string key, bool gltf)
        : folder_(std::move(folder)), worker_(worker), key_(std::move(key)), gltf_(gltf) {}
    /// Writes a shape. Returns whether this program was first; if not, sets the shape's record to that of the other
    /// program. Throws DataError if it cannot write.
    bool write(BatchShape& shape) const;

  private:
    bool is_done(BatchShape& shape, const std::filesystem::path& record) const;
    void try_to_write_labels(BatchShape& shape, const std::filesystem::path& target) const;
    void write_labels(BatchShape& shape, const std::filesystem::path& target) const;
    std::filesystem::path folder_;
    const WorkerFolder& worker_;
    std::string key_;
    bool gltf_;
};

}  // namespace exemplar
