#include "host/data/catalog/database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <array>
#include <chrono>
#include <fstream>
#include <limits>
#include <thread>

#include "host/core/errors.h"
#include "host/core/files.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr int k_busy_timeout_ms = 60'000;  ///< how long to wait for the changes of another process
constexpr int k_longest_value = 64 << 20;  ///< maximum bytes of a text: far more than any of ours

[[noreturn]] void throw_sqlite_error(const std::string& name, sqlite3* database, int code) {
    const int kind = code & 0xff;
    const char* const what = database ? sqlite3_errmsg(database) : sqlite3_errstr(code);
    if (kind == SQLITE_FULL) throw DataError(fmt::format("{}: the disk is full; make room and start again", name));
    if (kind == SQLITE_NOTADB || kind == SQLITE_CORRUPT)
        throw DataError(fmt::format("{}: is no catalog, or a damaged one ({})", name, what));
    if (kind == SQLITE_BUSY) throw DataError(fmt::format("{}: is kept busy by another program; try again later", name));
    if (kind == SQLITE_READONLY || kind == SQLITE_PERM || kind == SQLITE_CANTOPEN)
        throw DataError(fmt::format("{}: cannot be opened for writing ({})", name, what));
    throw DataError(fmt::format("{}: {}", name, what));
}

/// Switches to a write-ahead log. If several programs open a new file at once, or the last user was killed, one of
/// them makes the change; SQLite reports busy to the others at once, whatever their timeout.
void use_write_ahead_log(const std::string& name, sqlite3* database) {
    constexpr int k_pause_ms = 10;
    int code = SQLITE_BUSY;
    for (int waited = 0; (code & 0xff) == SQLITE_BUSY && waited < k_busy_timeout_ms; waited += k_pause_ms) {
        if (waited > 0) std::this_thread::sleep_for(std::chrono::milliseconds(k_pause_ms));
        code = sqlite3_exec(database, "PRAGMA journal_mode = WAL", nullptr, nullptr, nullptr);
    }
    if (code != SQLITE_OK) throw_sqlite_error(name, database, code);
}

}  // namespace

Statement::Statement(std::shared_ptr<sqlite3> database, std::string_view sql, std::string name)
    : database_(std::move(database)), statement_(nullptr, sqlite3_finalize), name_(std::move(name)) {
    sqlite3_stmt* statement = nullptr;
    check(sqlite3_prepare_v2(database_.get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr));
    statement_.reset(statement);
}

void Statement::check(int code) const {
    if (code != SQLITE_OK && code != SQLITE_ROW && code != SQLITE_DONE)
        throw_sqlite_error(name_, database_.get(), code);
}

bool Statement::step() {
    const int code = sqlite3_step(statement_.get());
    check(code);
    if (code == SQLITE_ROW) return true;
    reset();  // ends the read transaction, which the changes of others may wait for
    return false;
}

void Statement::run() {
    while (step()) continue;
}

void Statement::reset() {
    sqlite3_reset(statement_.get());
}

void Statement::bind_one(int index, std::int64_t value) {
    check(sqlite3_bind_int64(statement_.get(), index, value));
}

void Statement::bind_one(int index, double value) {
    check(sqlite3_bind_double(statement_.get(), index, value));  // SQLite stores NaN as NULL
}

void Statement::bind_one(int index, std::string_view value) {
    check(sqlite3_bind_text64(statement_.get(), index, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}

void Statement::bind_null(int index) {
    check(sqlite3_bind_null(statement_.get(), index));
}

bool Statement::is_null(int column) const {
    return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

std::int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(statement_.get(), column);
}

double Statement::real(int column) const {
    if (is_null(column)) return std::numeric_limits<double>::quiet_NaN();
    return sqlite3_column_double(statement_.get(), column);
}

std::string Statement::text(int column) const {
    const void* const bytes = sqlite3_column_text(statement_.get(), column);
    if (!bytes) return {};
    return {static_cast<const char*>(bytes), static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

Database::Database(const fs::path& path, Open open) : name_(path.string()) {
    std::error_code ignored;
    if (open == Open::existing && !fs::exists(path, ignored))
        throw DataError(fmt::format("{}: no such catalog{}", name_, suggest_file(path)));
    if (open == Open::create && path.has_parent_path()) fs::create_directories(path.parent_path(), ignored);
    const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_FULLMUTEX | (open == Open::create ? SQLITE_OPEN_CREATE : 0);
    sqlite3* database = nullptr;
    const int code = sqlite3_open_v2(path.c_str(), &database, flags, nullptr);
    database_ = std::shared_ptr<sqlite3>(database, sqlite3_close_v2);
    if (code != SQLITE_OK) throw_sqlite_error(name_, database, code);
    sqlite3_extended_result_codes(database, 1);
    sqlite3_busy_timeout(database, k_busy_timeout_ms);
    // A foreign file must not run anything through its views and triggers.
    sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_limit(database, SQLITE_LIMIT_LENGTH, k_longest_value);
    use_write_ahead_log(name_, database);
    execute("PRAGMA synchronous = NORMAL");  // survives a killed program; a power cut may lose the last changes
    execute("PRAGMA foreign_keys = ON");
}

Statement Database::prepare(std::string_view sql) {
    return {database_, sql, name_};
}

void Database::execute(const std::string& sql) {
    const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
    if (code != SQLITE_OK) throw_sqlite_error(name_, database_.get(), code);
}

void Database::transaction(const std::function<void()>& work) {
    execute("BEGIN IMMEDIATE");
    try {
        work();
        execute("COMMIT");
    } catch (...) {
        // An error may have ended the transaction already.
        if (sqlite3_get_autocommit(database_.get()) == 0)
            sqlite3_exec(database_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
        throw;
    }
}

std::int64_t Database::changes() const {
    return sqlite3_changes64(database_.get());
}

bool is_database(const fs::path& path) {
    constexpr std::string_view k_begin("SQLite format 3\0", 16);
    std::array<char, k_begin.size()> begin{};
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return false;
    std::ifstream stream(path, std::ios::binary);
    stream.read(begin.data(), begin.size());
    return static_cast<std::size_t>(stream.gcount()) == begin.size() &&
           std::string_view(begin.data(), begin.size()) == k_begin;
}

}  // namespace exemplar
