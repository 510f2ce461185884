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

/// What labels depend on of a shape: its content, and its category if the user gave it.
std::string content_of(const CatalogShape& shape);

/// The labeling of a catalog's shapes by certain models into a certain folder. Several programs may be at work on one
/// run: each claims some shapes at a time, and what it has claimed is given free when it ends, however it ends.
class CatalogRun {
  public:
    /// What is known of one shape in this run. `state` is "claimed" or that of the record.
    struct Labeled {
        CatalogShape shape;
        std::string state;
        ShapeRecord record;
    };
    struct Counts {
        std::int64_t done = 0, failed = 0, unknown = 0, claimed = 0;
        std::int64_t open = 0;  ///< not begun
    };

    /// The run of that key into that folder, which is made if it is new. `models` is for people.
    CatalogRun(Catalog& catalog, const std::string& key, const std::filesystem::path& folder,
               const std::string& models);
    /// A run by its number; throws DataError if there is none.
    CatalogRun(Catalog& catalog, std::int64_t id);

    /// Takes up to `most` shapes with a number above `after` that are neither labeled as they are now nor claimed, in
    /// order of number.
    std::vector<CatalogShape> claim(const std::string& worker, std::size_t most, std::int64_t after);
    /// Keeps what became of a shape, once: a later record of the same content changes nothing. Returns whether it was
    /// the first.
    bool finish(std::int64_t shape, const ShapeRecord& record);
    /// Gives free what a worker has claimed and not finished.
    void release(const std::string& worker);
    /// Who has claimed something.
    std::vector<std::string> workers();
    /// Forgets what became of a shape: it is open again.
    void reopen(std::int64_t shape);

    Counts counts();
    /// All shapes that are claimed or finished, in order of number, under an SQL condition. `use` changes nothing.
    void for_each(const std::function<void(const Labeled&)>& use, std::string_view where = "1");
    /// Up to `most` shapes with a number above `after` of which nothing became yet, claimed or not.
    std::vector<CatalogShape> open_shapes(std::size_t most, std::int64_t after);
    /// Keeps the records that lie in the run's folder and not yet in the catalog, each once; returns how many. Calls
    /// `looked` with the number of shapes it has looked for so far.
    std::size_t merge_records(const std::function<void(std::size_t)>& looked);

    /// Where the record of a shape is; throws DataError if the shape's name leads out of the folder.
    std::filesystem::path record_path(const CatalogShape& shape) const;
    /// The record in the folder if it is about the shape as it is now, and of this run.
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

/// A run, for people.
struct RunSummary {
    std::int64_t id;
    std::string key, folder, models;
    double started;
};
/// All runs of a catalog, the latest last.
std::vector<RunSummary> runs_of(Catalog& catalog);

}  // namespace exemplar
