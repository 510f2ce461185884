#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/data/catalog/catalog.h"
#include "host/data/catalog/shape_record.h"

namespace exemplar {

/// Returns what the labels of a shape depend on: its content hash, and its category if the user gave one.
std::string content_of(const CatalogShape& shape);

/// The labeling of a catalog's shapes with certain models into a certain folder. Several programs may work on one
/// run: each claims some shapes at a time. Its unfinished claims are released when it ends, however it ends.
class CatalogRun {
  public:
    /// The result of one shape in this run. `state` is "claimed" or that of the record.
    struct Labeled {
        CatalogShape shape;
        std::string state;
        ShapeRecord record;
    };
    struct Counts {
        std::int64_t done = 0, failed = 0, unknown = 0, claimed = 0;
        std::int64_t open = 0;  ///< neither claimed nor finished
    };

    /// Opens the run with that key and folder; creates it if it is new. `models` is a description for people.
    CatalogRun(Catalog& catalog, const std::string& key, const std::filesystem::path& folder,
               const std::string& models);
    /// Opens a run by its number; throws DataError if there is none.
    CatalogRun(Catalog& catalog, std::int64_t id);

    /// Claims up to `most` shapes with a number above `after` that are neither claimed nor labeled with their
    /// current content, in order of number.
    std::vector<CatalogShape> claim(const std::string& worker, std::size_t most, std::int64_t after);
    /// Stores the result of a shape once: a later record of the same content changes nothing. Returns whether this
    /// was the first.
    bool finish(std::int64_t shape, const ShapeRecord& record);
    /// Releases the unfinished claims of a worker.
    void release(const std::string& worker);
    /// Returns the workers that hold claims.
    std::vector<std::string> workers();
    /// Deletes the result of a shape, which is open again.
    void reopen(std::int64_t shape);

    Counts counts();
    /// Calls `use` for all shapes that are claimed or finished and meet an SQL condition, in order of number. `use`
    /// must not change the catalog.
    void for_each(const std::function<void(const Labeled&)>& use, std::string_view where = "1");
    /// Returns up to `most` shapes with a number above `after` that have no result yet, claimed or not.
    std::vector<CatalogShape> open_shapes(std::size_t most, std::int64_t after);
    /// Stores the records that lie in the run's folder but not yet in the catalog, each once; returns how many.
    /// Calls `looked` with the number of shapes checked so far.
    std::size_t merge_records(const std::function<void(std::size_t)>& looked);

    /// Returns the path of a shape's record; throws DataError if the shape's name leads out of the folder.
    std::filesystem::path record_path(const CatalogShape& shape) const;
    /// Returns the record in the folder if it belongs to this run and to the current content of the shape.
    std::optional<ShapeRecord> record_of(const CatalogShape& shape) const;

    std::int64_t id() const { return id_; }
    const std::string& key() const { return key_; }
    const std::filesystem::path& folder() const { return folder_; }

  private:
    bool merge(const CatalogShape& shape, const ShapeRecord& record);
    Catalog& catalog_;
    std::int64_t id_ = 0;
    std::string key_;
    std::filesystem::path folder_;
};

/// Description of a run for people.
struct RunSummary {
    std::int64_t id;
    std::string key, folder, models;
    double started;
};
/// Returns all runs of a catalog, the latest last.
std::vector<RunSummary> runs_of(Catalog& catalog);

}  // namespace exemplar
