#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace exemplar::mesh_io {

/// Throws MeshError "NAME: MESSAGE".
[[noreturn]] void fail(const std::string& name, const std::string& message);
/// Returns foreign text for an error message: its first `longest` bytes, with ? for everything that is not printable
/// or not UTF-8, and ... if it was cut.
std::string printable(std::string_view text, std::size_t longest);
/// Returns the first characters of foreign text, printable and in quotes, for an error message.
std::string quote(std::string_view text);

/// Parses all of `word` as a number: decimal, with or without sign and exponent, or nan or inf; returns nothing if
/// it is none. A value too large or small for a float becomes infinity or zero.
std::optional<float> parse_float(std::string_view word);
/// Parses as parse_float does, with the precision of a double. Rounded to a float, the result is that of parse_float.
std::optional<double> parse_number(std::string_view word);
/// Parses all of `word` as a decimal integer; returns nothing if it is none.
std::optional<std::int64_t> parse_integer(std::string_view word);

bool is_space(char c);
/// Returns `text` without spaces around it.
std::string_view trimmed(std::string_view text);
/// Removes the first word from `line` and returns it (words are separated by white space); empty if none is left.
std::string_view take_word(std::string_view& line);

/// Returns `text` without the byte order mark of UTF-8 that some editors put before it.
std::string_view without_mark(std::string_view text);
/// Throws if `text` begins with the byte order mark of UTF-16.
void refuse_utf16(std::string_view text, const std::string& name);

/// Walks through the lines of a text file in memory and the words of each line. Lines end with LF, CR LF or CR.
/// Errors are MeshError "NAME:LINE: MESSAGE".
class TextCursor {
  public:
    /// `comment`: a character that starts a comment which reaches to the end of its line; 0 for none.
    /// `text` must outlive the cursor.
    TextCursor(std::string_view text, std::string name, char comment = 0);

    /// Continues behind byte `offset`, the end of line `line_number`.
    void jump(std::size_t offset, std::size_t line_number);
    /// Moves to the next line that is not blank or a comment; returns false at the end of the text.
    bool next_line();
    /// Moves as next_line() does; throws "the file ends where EXPECTED should be" at the end of the text.
    void need_line(std::string_view expected);
    /// Returns the current line without the words already taken.
    std::string_view rest() const { return line_; }
    std::size_t line_number() const { return line_number_; }
    /// Returns the number of bytes after the current line.
    std::size_t bytes_left() const { return text_.size() - next_; }

    /// Takes the next word of the line; empty at its end.
    std::string_view word() { return take_word(line_); }
    /// Puts back `tail`, the end of the word taken last, as the next word.
    void put_back(std::string_view tail) {
        line_ = {tail.data(), static_cast<std::size_t>(line_.data() + line_.size() - tail.data())};
    }
    /// Takes a number, or throws an error that names `what`.
    double number(std::string_view what);
    std::int64_t integer(std::string_view what);

    [[noreturn]] void fail(const std::string& message) const;

  private:
    [[noreturn]] void fail_word(std::string_view word, std::string_view what, std::string_view kind) const;
    std::string_view text_, line_;
    std::string name_;
    std::size_t next_ = 0, line_number_ = 0;
    char comment_, line_end_;
};

}  // namespace exemplar::mesh_io
