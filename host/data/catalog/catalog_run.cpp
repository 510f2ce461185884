#include "host/data/catalog/catalog_run.h"

#include <fmt/format.h>

#include <chrono>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/json_text.h"
#include "host/core/memory_budget.h"
#include "host/data/catalog/shape_scan.h"

namespace exemplar {
namespace {

using Json = nlohmann::json;

// content_of as an SQL expression.
constexpr const char* k_content =
    "(shapes.hash || CASE WHEN shapes.category = '' THEN '' ELSE ' ' || shapes.category END)";

std::string dump(const Json& json) {
    return json_text(json);
}

/// Reads a record from the columns `first`, ... of a row, as for_each selects them.
ShapeRecord record_of_row(const Statement& row, int first) {
    ShapeRecord record;
    record.content = row.text(first);
    record.worker = row.text(first + 1);
    record.error = row.text(first + 2);
    record.model = row.text(first + 3);
    record.model_hash = row.text(first + 4);
    record.category = row.text(first + 5);
    record.category_probability = row.real(first + 6);
    record.confidence = row.real(first + 7);
    record.finished = row.real(first + 8);
    if (Json labels = parse_shallow(row.text(first + 9)); labels.is_array()) record.labels = labels;
    if (Json seconds = parse_shallow(row.text(first + 10)); seconds.is_object()) record.seconds = seconds;
    return record;
}

/// Returns whether a record is older than the file and the file is as the catalog knows it; then its content need
/// not be read.
bool is_older_than_file(const ShapeRecord& record, const CatalogShape& shape) {
    using std::chrono::file_clock, std::chrono::nanoseconds;
    const auto changed = file_clock::to_sys(file_clock::time_point(nanoseconds(shape.modified)));
    if (!(record.finished < std::chrono::duration<double>(changed.time_since_epoch()).count())) return false;
    try {
        const CatalogShape now = stat_shape(shape.path);
        return now.bytes == shape.bytes && now.modified == shape.modified;
    } catch (const DataError&) {
        return false;
    }
}

/// Returns the shapes of a query for those above `after`, in order of number. Throws DataError if numbers do not
/// increase, as in a forged file: asking for those above the last one would then never end.
std::vector<CatalogShape> shapes_above(std::int64_t after, Statement& query, const std::string& catalog) {
    std::vector<CatalogShape> shapes;
    while (query.step()) {
        shapes.push_back(read_shape(query));
        if (shapes.back().id <= after)
            throw DataError(fmt::format("{}: is damaged: its shapes have no numbers; add them to a new one", catalog));
        after = shapes.back().id;
    }
    return shapes;
}

}  // namespace

std::string content_of(const CatalogShape& shape) {
    return shape.category.empty() ? shape.hash : shape.hash + ' ' + shape.category;
}

CatalogRun::CatalogRun(Catalog& catalog, const std::string& key, const std::filesystem::path& folder,
                       const std::string& models)
    : catalog_(catalog), key_(key), folder_(folder) {
    Database& database = catalog.database();
    database.prepare("INSERT OR IGNORE INTO runs(key, folder, models, started) VALUES(?, ?, ?, ?)")
        .bind(key, folder.string(), models, seconds_since_1970())
        .run();
    Statement query = database.prepare("SELECT id FROM runs WHERE key = ? AND folder = ?");
    if (query.bind(key, folder.string()).step()) id_ = query.integer(0);
}

CatalogRun::CatalogRun(Catalog& catalog, std::int64_t id) : catalog_(catalog), id_(id) {
    Statement query = catalog.database().prepare("SELECT key, folder FROM runs WHERE id = ?");
    if (!query.bind(id).step()) throw DataError(fmt::format("{}: has no run {}", catalog.database().name(), id));
    key_ = query.text(0);
    folder_ = query.text(1);
}

std::vector<CatalogShape> CatalogRun::claim(const std::string& worker, std::size_t most, std::int64_t after) {
    Database& database = catalog_.database();
    std::vector<CatalogShape> shapes;
    database.transaction([&] {
        Statement open = database.prepare(
            fmt::format("SELECT {} FROM shapes WHERE id > ?2 AND problem = '' AND NOT EXISTS(SELECT 1 FROM labels "
                        "WHERE run = ?1 AND shape = shapes.id AND (state = 'claimed' OR content = {})) "
                        "ORDER BY id LIMIT ?3",
                        k_shape_columns, k_content));
        open.bind(id_, after, static_cast<std::int64_t>(most));
        shapes = shapes_above(after, open, database.name());
        Statement take = database.prepare(
            "INSERT OR REPLACE INTO labels(run, shape, state, worker, content) VALUES(?, ?, 'claimed', ?, ?)");
        for (const CatalogShape& shape : shapes) take.bind(id_, shape.id, worker, content_of(shape)).run();
    });
    return shapes;
}

bool CatalogRun::finish(std::int64_t shape, const ShapeRecord& record) {
    Database& database = catalog_.database();
    Statement keep = database.prepare(
        "INSERT INTO labels(run, shape, state, worker, content, model, model_hash, category, category_probability, "
        "confidence, labels, error, seconds, seconds_all, finished) VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, "
        "?11, ?12, ?13, ?14, ?15) ON CONFLICT DO UPDATE SET state = ?3, worker = ?4, content = ?5, model = ?6, "
        "model_hash = ?7, category = ?8, category_probability = ?9, confidence = ?10, labels = ?11, error = ?12, "
        "seconds = ?13, seconds_all = ?14, finished = ?15 WHERE state = 'claimed' OR content <> ?5");
    bool first = false;
    database.transaction([&] {
        keep.bind(id_, shape, record.state(), record.worker, record.content, record.model, record.model_hash,
                  record.category, record.category_probability, record.confidence, dump(record.labels), record.error,
                  dump(record.seconds), record.seconds_all(), record.finished)
            .run();
        first = database.changes() > 0;
        if (first && !record.features.empty()) catalog_.set_features(shape, record.features);
    });
    return first;
}

void CatalogRun::release(const std::string& worker) {
    catalog_.database()
        .prepare("DELETE FROM labels WHERE run = ? AND state = 'claimed' AND worker = ?")
        .bind(id_, worker)
        .run();
}

std::vector<std::string> CatalogRun::workers() {
    Statement query =
        catalog_.database().prepare("SELECT DISTINCT worker FROM labels WHERE run = ? AND state = 'claimed'");
    query.bind(id_);
    std::vector<std::string> workers;
    while (query.step()) workers.push_back(query.text(0));
    return workers;
}

void CatalogRun::reopen(std::int64_t shape) {
    catalog_.database()
        .prepare("DELETE FROM labels WHERE run = ? AND shape = ? AND state <> 'claimed'")
        .bind(id_, shape)
        .run();
}

CatalogRun::Counts CatalogRun::counts() {
    Statement query = catalog_.database().prepare(
        fmt::format("SELECT sum(state = 'done'), sum(state = 'failed'), sum(state = 'unknown'), "
                    "sum(state = 'claimed'), sum(state IS NULL) FROM shapes LEFT JOIN labels ON labels.shape = "
                    "shapes.id AND labels.run = ? "
                    "AND (state = 'claimed' OR content = {}) WHERE problem = ''",
                    k_content));
    if (!query.bind(id_).step()) return {};
    return {.done = query.integer(0),
            .failed = query.integer(1),
            .unknown = query.integer(2),
            .claimed = query.integer(3),
            .open = query.integer(4)};
}

void CatalogRun::for_each(const std::function<void(const Labeled&)>& use, std::string_view where) {
    Statement query = catalog_.database().prepare(fmt::format(
        "SELECT {}, labels.content, labels.worker, error, model, model_hash, labels.category, category_probability, "
        "confidence, finished, labels, seconds, state FROM labels JOIN shapes ON shapes.id = labels.shape "
        "WHERE run = ? AND ({}) ORDER BY shapes.id",
        k_shape_columns, where));
    query.bind(id_);
    constexpr int k_first = 13;  // after those of the shape
    while (query.step()) {
        check_interrupt();
        use({read_shape(query), query.text(k_first + 11), record_of_row(query, k_first)});
    }
}

std::vector<CatalogShape> CatalogRun::open_shapes(std::size_t most, std::int64_t after) {
    Statement query = catalog_.database().prepare(
        fmt::format("SELECT {} FROM shapes WHERE id > ?2 AND problem = '' AND NOT EXISTS(SELECT 1 FROM labels WHERE "
                    "run = ?1 AND shape = shapes.id AND state <> 'claimed' AND content = {}) ORDER BY id LIMIT ?3",
                    k_shape_columns, k_content));
    query.bind(id_, after, static_cast<std::int64_t>(most));
    return shapes_above(after, query, catalog_.database().name());
}

std::size_t CatalogRun::merge_records(const std::function<void(std::size_t)>& looked) {
    constexpr std::size_t k_at_a_time = 1000;
    std::size_t merged = 0, seen = 0;
    std::int64_t last = 0;
    for (;;) {
        const std::vector<CatalogShape> shapes = open_shapes(k_at_a_time, last);
        if (shapes.empty()) return merged;
        for (const CatalogShape& shape : shapes) {
            check_interrupt();
            if (const auto record = read_record(record_path(shape)); record && record->run == key_)
                merged += merge(shape, *record) ? 1 : 0;
            looked(++seen);
        }
        last = shapes.back().id;
    }
}

bool CatalogRun::merge(const CatalogShape& shape, const ShapeRecord& record) {
    if (record.content == content_of(shape)) return finish(shape.id, record);
    if (is_older_than_file(record, shape)) return false;
    // The process that labeled the file had found it changed; the record counts if it fits the current file.
    CatalogShape now = describe_shape(shape.path, usable_memory() / 2);
    now.name = shape.name;
    now.category = shape.category;
    if (record.content != content_of(now)) return false;
    catalog_.put(std::span(&now, 1));
    return finish(shape.id, record);
}

std::filesystem::path CatalogRun::record_path(const CatalogShape& shape) const {
    if (!is_output_name(shape.name))
        throw DataError(fmt::format("{}: the name '{}' of shape {} leads out of the output folder",
                                    catalog_.database().name(), shape.name, shape.id));
    return folder_ / (shape.name + ".json");
}

std::optional<ShapeRecord> CatalogRun::record_of(const CatalogShape& shape) const {
    std::optional<ShapeRecord> record = read_record(record_path(shape));
    if (record && record->run == key_ && record->content == content_of(shape)) return record;
    return {};
}

std::vector<RunSummary> runs_of(Catalog& catalog) {
    Statement query = catalog.database().prepare("SELECT id, key, folder, models, started FROM runs ORDER BY id");
    std::vector<RunSummary> runs;
    while (query.step()) runs.push_back({query.integer(0), query.text(1), query.text(2), query.text(3), query.real(4)});
    return runs;
}

}  // namespace exemplar
