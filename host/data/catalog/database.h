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

/// A prepared SQL statement. Values are bound in order by bind(); texts are bytes, in any encoding.
class Statement {
  public:
    /// Binds these values to the parameters 1, 2, ...: whole numbers, floating-point numbers (NaN is NULL), texts, or
    /// optionals of them (nothing is NULL). Forgets earlier rows.
    template <typename... Values>
    Statement& bind(const Values&... values) {
        reset();
        int index = 0;
        (bind_one(++index, values), ...);
        return *this;
    }
    /// Moves to the next row; false after the last. Throws DataError.
    bool step();
    /// Runs to the end.
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

/// An SQLite database file. One thread at a time uses an object; several objects, in several processes of one machine,
/// may use one file. Waits up to a minute for another's changes.
class Database {
  public:
    enum class Open { existing, create };

    /// Opens the file, with a write-ahead log. Throws DataError naming it: missing, no database, not writable.
    Database(const std::filesystem::path& path, Open open);

    /// Throws DataError: wrong SQL, a damaged file.
    Statement prepare(std::string_view sql);
    /// Runs statements without parameters.
    void execute(const std::string& sql);
    /// Makes all changes of `work` in one step, or none of them if it throws; others change nothing meanwhile.
    void transaction(const std::function<void()>& work);
    /// How many rows the last statement changed.
    std::int64_t changes() const;
    const std::string& name() const { return name_; }

  private:
    std::string name_;
    std::shared_ptr<sqlite3> database_;
};

/// Whether the file begins as an SQLite database does.
bool is_database(const std::filesystem::path& path);

}  // namespace exemplar
