#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace exemplar {

/// A prepared SQL statement. Texts are bytes in any encoding.
class Statement {
  public:
    /// Binds these values to the parameters 1, 2, ...: integers, floating-point numbers (NaN is NULL), texts, or
    /// optionals of them (nullopt is NULL). Discards earlier rows.
    template <typename... Values>
    Statement& bind(const Values&... values) {
        reset();
        int index = 0;
        (bind_one(++index, values), ...);
        return *this;
    }
    /// Moves to the next row; returns false after the last. Throws DataError.
    bool step();
    /// Steps through all rows.
    void run();

    bool is_null(int column) const;
    std::int64_t integer(int column) const;  ///< 0 for NULL
    double real(int column) const;           ///< NaN for NULL
    std::string text(int column) const;      ///< empty for NULL

  private:
    friend class Database;
    Statement(std::shared_ptr<sqlite3> database, std::string_view sql, std::string name);
    void reset();
    void bind_one(int index, std::int64_t value);
    void bind_one(int index, double value);
    void bind_one(int index, std::string_view value);
    void bind_null(int index);
    template <typename T>
    void bind_one(int index, const std::optional<T>& value) {
        value ? bind_one(index, *value) : bind_null(index);
    }
    void check(int code) const;

    std::shared_ptr<sqlite3> database_;
    std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_;
    std::string name_;
};

/// An SQLite database file. Each object is for one thread at a time; several objects, in several processes of one
/// machine, may use one file. Waits up to a minute for the changes of others.
class Database {
  public:
    enum class Open { existing, create };

    /// Opens the file with a write-ahead log. Throws DataError naming it if it is missing, no database or not
    /// writable.
    Database(const std::filesystem::path& path, Open open);

    /// Prepares a statement. Throws DataError if the SQL is wrong or the file is damaged.
    Statement prepare(std::string_view sql);
    /// Runs statements without parameters.
    void execute(const std::string& sql);
    /// Makes all changes of `work` in one step, or none if it throws; nobody else changes anything meanwhile.
    void transaction(const std::function<void()>& work);
    /// Returns how many rows the last statement changed.
    std::int64_t changes() const;
    const std::string& name() const { return name_; }

  private:
    std::string name_;
    std::shared_ptr<sqlite3> database_;
};

/// Returns whether the file begins as an SQLite database does.
bool is_database(const std::filesystem::path& path);

}  // namespace exemplar
