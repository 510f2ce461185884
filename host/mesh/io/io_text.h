#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace exemplar::mesh_io {

/// Throws MeshError "NAME: MESSAGE".
[[noreturn]] void fail(const std::string& name, const std::string& message);
/// Foreign text for an error message: its first `longest` bytes, in which ? stands for what is not printable or no
/// UTF-8, and ... if that is not all.
std::string printable(std::string_view text, std::size_t longest);
/// A few characters of foreign text, printable and in quotes, for an error message.
std::string quote(std::string_view text);

/// The number that fills all of `word`, if one does: decimal, with or without sign and exponent, or nan or inf.
/// What is too large or small for a float becomes infinity or zero.
std::optional<float> parse_float(std::string_view word);
/// The decimal integer that fills all of `word`, if one does.
std::optional<std::int64_t> parse_integer(std::string_view word);

bool is_space(char c);
/// `text` without spaces around it.
std::string_view trimmed(std::string_view text);
/// Takes the first word off `line` (words are separated by spaces or tabs); empty when none is left.
std::string_view take_word(std::string_view& line);
std::string lower_case(std::string_view text);

/// Walks through the lines of a text file in memory and the words of each line. Lines end with LF, CR LF or CR.
/// Errors are MeshError "NAME:LINE: MESSAGE".
class TextCursor {
  public:
    /// `comment`: a character that starts a comment which reaches to the end of its line; 0 for none.
    /// `text` must outlive the cursor.
    TextCursor(std::string_view text, std::string name, char comment = 0);

    /// Goes on behind byte `offset`, the end of line `line_number`.
    void jump(std::size_t offset, std::size_t line_number);
    /// Goes to the next line that holds anything; false at the end of the text.
    bool next_line();
    /// Goes to the next line that holds anything; throws "the file ends where EXPECTED should be" if there is none.
    void need_line(std::string_view expected);
    /// The current line, from where words were taken off.
    std::string_view rest() const { return line_; }
    std::size_t line_number() const { return line_number_; }
    /// Byte just after the current line.
    std::size_t bytes_left() const { return text_.size() - next_; }

    /// Takes the next word of the line; empty at the line's end.
    std::string_view word() { return take_word(line_); }
    /// Makes the end `tail` of the latest word the next one.
    void put_back(std::string_view tail) {
        line_ = {tail.data(), static_cast<std::size_t>(line_.data() + line_.size() - tail.data())};
    }
    /// Takes a number or throws an error that names `what`.
    float number(std::string_view what);
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
