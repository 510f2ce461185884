#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/data/catalog/database.h"

namespace exemplar {

/// One mesh file of a catalog.
struct CatalogShape {
    std::int64_t id = 0;          ///< 0 until it is in a catalog
    std::filesystem::path path;   ///< absolute
    std::string name;             ///< its results are FOLDER/NAME_labels.txt and so on; unique, see is_output_name
    std::int64_t bytes = 0;       ///< of the file
    std::int64_t modified = 0;    ///< of the file, nanoseconds
    std::string hash;             ///< XXH3-128 of the file's content, 32 hexadecimal digits
    std::int64_t vertices = 0;    ///< as read
    std::int64_t faces = 0;       ///< of the file: a polygon is one
    std::int64_t components = 0;  ///< pieces, vertices at the same place being one
    std::string problem;          ///< why it cannot be used; empty if it can
    std::string warnings;         ///< what is unusual about it, a line each
    std::string category;         ///< as given by the user; may be empty
    std::string features;         ///< its entry in the cache of features, once computed
};

/// Files with what is known of them, in one SQLite file that several programs may use at once (of one machine: on
/// network file systems only one at a time). One thread at a time uses an object.
class Catalog {
  public:
    /// Opens a catalog or makes a new one. Throws DataError: no catalog, damaged, of a newer program, not writable.
    Catalog(const std::filesystem::path& path, Database::Open open);

    /// Adds these in one step, or replaces what is known of their paths. A shape that was known keeps its name, and its
    /// category unless a new one is given; a new one gets the name asked for, or one made unique by a suffix.
    /// Throws UsageError for a name that is no output name.
    void put(std::span<const CatalogShape> shapes);
    /// What is known of a path.
    std::optional<CatalogShape> find(const std::filesystem::path& path);
    /// Calls `use` for every shape in the order they were added; `where` is an SQL condition over the table's columns.
    void for_each(const std::function<void(const CatalogShape&)>& use, std::string_view where = "1");
    /// How many shapes there are, under an SQL condition.
    std::int64_t count(std::string_view where = "1");
    void set_features(std::int64_t shape, std::string_view entry);

    Database& database() { return database_; }

  private:
    std::string free_name(const std::string& wanted, const std::filesystem::path& path);
    Database database_;
};

/// Columns of `shapes` that read_shape takes, in order.
extern const char* const k_shape_columns;
/// A shape from a row that begins with k_shape_columns.
CatalogShape read_shape(const Statement& row);

/// Now, as times in a catalog are kept.
double seconds_since_1970();

/// Whether files of that name lie below the folder they are written to, and in no hidden one: parts between slashes of
/// printable characters, none empty or beginning with a dot, no folder called like a result (a.ply), at most 200 bytes
/// each and 1000 in all.
bool is_output_name(std::string_view name);
/// An output name that is as near to `path` (relative, with or without extension) as can be.
std::string output_name(const std::filesystem::path& path);

}  // namespace exemplar
