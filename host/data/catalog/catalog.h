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
    std::int64_t modified = 0;    ///< time of the file's last change, in nanoseconds
    std::string hash;             ///< XXH3-128 of the file's content, 32 hexadecimal digits
    std::int64_t vertices = 0;    ///< as read from the file
    std::int64_t faces = 0;       ///< in the file: a polygon counts as one
    std::int64_t components = 0;  ///< connected pieces after welding vertices at the same place
    std::string problem;          ///< why it cannot be used; empty if it can
    std::string warnings;         ///< what is unusual about it, one per line
    std::string category;         ///< as given by the user; may be empty
    std::string features;         ///< name of its entry in the feature cache, once computed
};

/// A list of mesh files with what is known of each, in an SQLite file. Several programs of one machine may use it at
/// once; on network file systems only one at a time. Each object is for one thread at a time.
class Catalog {
  public:
    /// Opens a catalog or creates one. Throws DataError if the file is no catalog, damaged, from a newer program or
    /// not writable.
    Catalog(const std::filesystem::path& path, Database::Open open);

    /// Adds these shapes, or updates those whose path is known, in one transaction. A known shape keeps its name,
    /// and its category unless a new one is given. A new shape gets the name asked for, made unique by a suffix if
    /// need be. Throws UsageError for a name that is no output name.
    void put(std::span<const CatalogShape> shapes);
    /// Returns the shape with this path, if it is known.
    std::optional<CatalogShape> find(const std::filesystem::path& path);
    /// Calls `use` for every shape in the order in which they were added; `where` is an SQL condition over the
    /// table's columns.
    void for_each(const std::function<void(const CatalogShape&)>& use, std::string_view where = "1");
    /// Returns the number of shapes that meet an SQL condition.
    std::int64_t count(std::string_view where = "1");
    void set_features(std::int64_t shape, std::string_view entry);

    Database& database() { return database_; }

  private:
    std::string free_name(const std::string& wanted, const std::filesystem::path& path);
    Database database_;
};

/// The columns of `shapes` that read_shape reads, in order.
extern const char* const k_shape_columns;
/// Reads a shape from a row that begins with k_shape_columns.
CatalogShape read_shape(const Statement& row);

/// Returns the current time as catalogs store it.
double seconds_since_1970();

/// Returns whether files of that name lie below the folder they are written to, and in no hidden one. Parts between
/// slashes have printable characters and at most 200 bytes each, 1000 in all; none is empty or begins with a dot,
/// and no folder has the name of a result (a.ply).
bool is_output_name(std::string_view name);
/// Returns an output name as similar as possible to `path` (relative, with or without extension).
std::string output_name(const std::filesystem::path& path);

}  // namespace exemplar
