#include "host/data/catalog/catalog.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <utility>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t k_application = 0x45584350;  ///< distinguishes an Exemplar catalog from other SQLite files
constexpr std::int64_t k_catalog_format = 1;
constexpr std::size_t k_longest_part = 200;  ///< bytes; file systems allow 255, and endings are appended
constexpr std::size_t k_longest_name = 1000;

// Times are seconds since 1970. Rows of `labels` are claims until their state is no longer 'claimed'.
constexpr const char* k_tables = R"(
CREATE TABLE shapes(
    id INTEGER PRIMARY KEY,
    path TEXT NOT NULL UNIQUE,
    name TEXT NOT NULL UNIQUE,
    bytes INTEGER NOT NULL,
    modified INTEGER NOT NULL,
    hash TEXT NOT NULL,
    vertices INTEGER NOT NULL,
    faces INTEGER NOT NULL,
    components INTEGER NOT NULL,
    problem TEXT NOT NULL,
    warnings TEXT NOT NULL,
    category TEXT NOT NULL,
    features TEXT NOT NULL,
    added REAL NOT NULL);
CREATE TABLE runs(
    id INTEGER PRIMARY KEY,
    key TEXT NOT NULL,
    folder TEXT NOT NULL,
    models TEXT NOT NULL,
    started REAL NOT NULL,
    UNIQUE(key, folder));
CREATE TABLE labels(
    run INTEGER NOT NULL REFERENCES runs(id),
    shape INTEGER NOT NULL REFERENCES shapes(id),
    state TEXT NOT NULL,
    worker TEXT NOT NULL,
    content TEXT NOT NULL,
    model TEXT,
    model_hash TEXT,
    category TEXT,
    category_probability REAL,
    confidence REAL,
    labels TEXT,
    error TEXT,
    seconds TEXT,
    seconds_all REAL,
    finished REAL,
    PRIMARY KEY(run, shape)) WITHOUT ROWID;
CREATE INDEX labels_by_state ON labels(run, state);
)";

std::int64_t pragma(Database& database, const std::string& name) {
    Statement statement = database.prepare("PRAGMA " + name);
    return statement.step() ? statement.integer(0) : 0;
}

bool is_empty(Database& database) {
    Statement any = database.prepare("SELECT count(*) FROM sqlite_schema");
    return !any.step() || any.integer(0) == 0;
}

void make_tables(Database& database) {
    database.transaction([&] {
        if (pragma(database, "application_id") != 0 || !is_empty(database)) return;
        database.execute(k_tables);
        database.execute(
            fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", k_application, k_catalog_format));
    });
}

void check_tables(Database& database) {
    if (pragma(database, "application_id") != k_application)
        throw DataError(fmt::format("{}: is {}, no catalog", database.name(),
                                    is_empty(database) ? "empty" : "an SQLite file of something else"));
    if (const std::int64_t format = pragma(database, "user_version"); format != k_catalog_format)
        throw DataError(fmt::format(
            "{}: is a catalog of format {}, this program knows {}; {}", database.name(), format, k_catalog_format,
            format > k_catalog_format ? "get a newer Exemplar" : "add the shapes to a new one"));
}

bool is_plain(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x20 && byte != 0x7f && c != '/' && c != '\\';
}

bool is_output_part(std::string_view part) {
    return !part.empty() && part.front() != '.' && part.size() <= k_longest_part && std::ranges::all_of(part, is_plain);
}

/// Returns the first bytes of a text without cutting a character in two.
std::string cut_to(std::string text, std::size_t most) {
    if (text.size() <= most) return text;
    const std::size_t letter = 4;  // maximum bytes of a character
    text.resize(most);
    while (!text.empty() && !is_utf8(text) && text.size() + letter > most) text.pop_back();
    return text;
}

/// Turns a part of a path into an output part; returns an empty string if that is impossible.
std::string output_part(std::string part) {
    if (part == "." || part == ".." || part == "/") return {};
    for (char& c : part)
        if (!is_plain(c)) c = '_';
    if (!part.empty() && part.front() == '.') part.front() = '_';
    return cut_to(std::move(part), k_longest_part);
}

/// The endings of a shape's result files, after its name.
constexpr std::array<std::string_view, 5> k_result_endings{".json", ".seg", ".ply", ".glb", "_labels.txt"};

/// Returns whether a folder of that name could clash with a result file: a.ply lies where the results of a.off do.
bool is_result(std::string_view part) {
    return std::ranges::any_of(k_result_endings, [&](std::string_view ending) { return part.ends_with(ending); });
}

/// Turns the name of a folder into an output part that is not the name of a result file.
std::string output_folder_part(std::string part) {
    std::string safe = output_part(std::move(part));
    if (is_result(safe)) safe[safe.rfind('.')] = '_';
    return safe;
}

/// Appends `suffix` to an output name, cutting its last part if need be.
std::string with_suffix(const std::string& name, const std::string& suffix) {
    const std::size_t begin = name.rfind('/') + 1;  // 0 without a slash
    const std::size_t most = std::min(k_longest_part, k_longest_name - begin);
    return name.substr(0, begin) + cut_to(name.substr(begin), most - std::min(most, suffix.size())) + suffix;
}

/// Returns a number n for which `is_taken` is false, but true for n - 1; assumes it is true for 1. Takes few steps
/// however many are taken.
std::size_t first_free(const std::function<bool(std::size_t)>& is_taken) {
    std::size_t taken = 1, free = 2;
    while (is_taken(free)) taken = std::exchange(free, 2 * free);
    while (free - taken > 1) {
        const std::size_t middle = taken + (free - taken) / 2;
        (is_taken(middle) ? taken : free) = middle;
    }
    return free;
}

}  // namespace

const char* const k_shape_columns =
    "shapes.id, shapes.path, shapes.name, shapes.bytes, shapes.modified, shapes.hash, shapes.vertices, shapes.faces, "
    "shapes.components, shapes.problem, shapes.warnings, shapes.category, shapes.features";

CatalogShape read_shape(const Statement& row) {
    return {.id = row.integer(0),
            .path = row.text(1),
            .name = row.text(2),
            .bytes = row.integer(3),
            .modified = row.integer(4),
            .hash = row.text(5),
            .vertices = row.integer(6),
            .faces = row.integer(7),
            .components = row.integer(8),
            .problem = row.text(9),
            .warnings = row.text(10),
            .category = row.text(11),
            .features = row.text(12)};
}

bool is_output_name(std::string_view name) {
    if (name.size() > k_longest_name) return false;
    for (;;) {
        const std::size_t slash = name.find('/');
        const std::string_view part = name.substr(0, slash);
        if (!is_output_part(part)) return false;
        if (slash == std::string_view::npos) return true;
        if (is_result(part)) return false;
        name.remove_prefix(slash + 1);
    }
}

std::string output_name(const fs::path& path) {
    std::string name;
    for (const fs::path& part : path.parent_path())
        if (const std::string safe = output_folder_part(part.string()); !safe.empty()) name += safe + '/';
    std::string last = output_part(path.stem().string());
    if (last.empty()) last = "shape";
    // Some bytes are left for a suffix that makes the name unique.
    return name.size() + k_longest_part <= k_longest_name ? name + last : last;
}

Catalog::Catalog(const fs::path& path, Database::Open open) : database_(path, open) {
    if (open == Database::Open::create) make_tables(database_);
    check_tables(database_);
}

double seconds_since_1970() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string Catalog::free_name(const std::string& wanted, const fs::path& path) {
    Statement taken = database_.prepare("SELECT 1 FROM shapes WHERE name = ?");
    const auto is_free = [&](const std::string& name) { return !taken.bind(name).step(); };
    if (!is_output_name(wanted))
        throw UsageError(fmt::format("{}: no file can be called '{}' in an output folder", path.string(), wanted));
    if (is_free(wanted)) return wanted;
    // If a.off has taken the name "a", a.obj becomes "a.obj".
    constexpr std::size_t k_longest_extension = 5;
    std::string extension = output_part(path.extension().string());
    if (!extension.empty()) extension.front() = '.';
    if (extension.size() <= k_longest_extension)
        if (std::string name = with_suffix(wanted, extension); is_free(name)) return name;
    const auto numbered = [&](std::size_t number) { return with_suffix(wanted, fmt::format(".{}", number)); };
    return numbered(first_free([&](std::size_t number) { return !is_free(numbered(number)); }));
}

void Catalog::put(std::span<const CatalogShape> shapes) {
    Statement known = database_.prepare("SELECT id FROM shapes WHERE path = ?");
    Statement replace = database_.prepare(
        "UPDATE shapes SET bytes = ?2, modified = ?3, vertices = ?5, faces = ?6, components = ?7, problem = ?8, "
        "warnings = ?9, category = CASE WHEN ?10 = '' THEN category ELSE ?10 END, "
        "features = CASE WHEN hash = ?4 THEN features ELSE ?11 END, hash = ?4 WHERE path = ?1");
    Statement insert = database_.prepare(
        "INSERT INTO shapes(path, bytes, modified, hash, vertices, faces, components, problem, warnings, category, "
        "features, name, added) VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13)");
    const double now = seconds_since_1970();
    database_.transaction([&] {
        for (const CatalogShape& shape : shapes) {
            const std::string path = shape.path.string();
            const auto bind = [&](Statement& statement, const auto&... more) -> Statement& {
                return statement.bind(path, shape.bytes, shape.modified, shape.hash, shape.vertices, shape.faces,
                                      shape.components, shape.problem, shape.warnings, shape.category, shape.features,
                                      more...);
            };
            if (known.bind(path).step())
                bind(replace).run();
            else
                bind(insert, free_name(shape.name, shape.path), now).run();
        }
    });
}

std::optional<CatalogShape> Catalog::find(const fs::path& path) {
    Statement query = database_.prepare(fmt::format("SELECT {} FROM shapes WHERE path = ?", k_shape_columns));
    if (!query.bind(path.string()).step()) return {};
    return read_shape(query);
}

void Catalog::for_each(const std::function<void(const CatalogShape&)>& use, std::string_view where) {
    Statement query =
        database_.prepare(fmt::format("SELECT {} FROM shapes WHERE {} ORDER BY id", k_shape_columns, where));
    while (query.step()) {
        check_interrupt();
        use(read_shape(query));
    }
}

std::int64_t Catalog::count(std::string_view where) {
    Statement query = database_.prepare(fmt::format("SELECT count(*) FROM shapes WHERE {}", where));
    return query.step() ? query.integer(0) : 0;
}

void Catalog::set_features(std::int64_t shape, std::string_view entry) {
    database_.prepare("UPDATE shapes SET features = ? WHERE id = ?").bind(entry, shape).run();
}

}  // namespace exemplar
