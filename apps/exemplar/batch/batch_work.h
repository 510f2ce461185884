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

/// What became of the shapes of a batch run, or of this program's part of it.
struct BatchCounts {
    std::size_t done = 0, failed = 0, unknown = 0;
    std::size_t taken_over = 0;  ///< of them, results of other programs that lay in the output folder already

    void count(const ShapeRecord& record, bool is_new);
    std::size_t all() const { return done + failed + unknown; }
};

/// The shapes that a program has to label. next() and finish() may be called from two threads.
class BatchWork {
  public:
    virtual ~BatchWork() = default;
    /// The next shape to label, or nothing. Results that lie in the output folder are taken over on the way.
    virtual std::optional<CatalogShape> next() = 0;
    /// Keeps what became of a shape whose record is in the output folder; `is_new`: this program made it.
    virtual void finish(const BatchShape& shape, bool is_new) = 0;
    /// How many there are to do, as far as it is known.
    virtual std::size_t total() = 0;
    BatchCounts counts() const {
        const std::lock_guard lock(mutex_);
        return counts_;
    }

  protected:
    mutable std::mutex mutex_;
    BatchCounts counts_;
};

/// Removes the record of the shape `name` in a run's folder. Throws DataError where a link lies on the way.
void remove_record(const std::filesystem::path& folder, const std::string& name);
/// Makes those open again that have no record in the run's folder any longer (somebody has removed it, or another run
/// has replaced it) and, with `retry`, those that failed or were of unknown category.
void reopen_shapes(CatalogRun& run, bool retry);

/// The shapes of a catalog's run that nobody has claimed yet.
class CatalogWork final : public BatchWork {
  public:
    /// `output` is where the worker's folder is; the run's folder is a folder in it.
    CatalogWork(Catalog& catalog, CatalogRun& run, const std::filesystem::path& output, const std::string& worker);
    /// Gives free what it had claimed.
    ~CatalogWork() override;
    std::optional<CatalogShape> next() override;
    void finish(const BatchShape& shape, bool is_new) override;
    std::size_t total() override;

  private:
    void free_claims_of_the_dead();
    bool claim_some();
    Catalog& catalog_;
    CatalogRun& run_;
    std::filesystem::path output_;
    std::string worker_;
    std::deque<CatalogShape> claimed_;
    std::int64_t last_ = 0;
    bool again_ = true;  ///< whether those before `last_` are looked for once more
};

/// Writes what became of shapes into an output folder, each with a record of what was done, so that no reader sees a
/// part of it: the record is written last, and only by one of several programs that label the same shape. Once it is
/// there the others leave all files of the shape as they are.
class BatchWriter {
  public:
    BatchWriter(std::filesystem::path folder, const WorkerFolder& worker, std::string key, bool gltf)
        : folder_(std::move(folder)), worker_(worker), key_(std::move(key)), gltf_(gltf) {}
    /// Throws DataError where it cannot write. Returns whether this program was the one; if not, the shape's record is
    /// that of the other.
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
