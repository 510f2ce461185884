#include "host/mesh/io/io_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

#include "host/core/errors.h"
#include "host/core/text.h"

namespace exemplar::mesh_io {

void fail(const std::string& name, const std::string& message) {
    throw MeshError(name + ": " + message);
}

std::string printable(std::string_view text, std::size_t longest) {
    std::size_t end = std::min(text.size(), longest);
    const auto is_continuation = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
    for (int i = 0; i < 3 && end > 0 && end < text.size() && is_continuation(text[end]); ++i)
        --end;  // does not cut a
                // character in
                // two
    const std::string_view shown = text.substr(0, end);
    const bool keeps_letters = is_utf8(shown);
    std::string result;
    for (char c : shown) {
        const bool is_ascii = c >= ' ' && c <= '~', is_letter = keeps_letters && static_cast<unsigned char>(c) >= 0x80;
        result += is_ascii || is_letter ? c : '?';
    }
    return result + (end < text.size() ? "..." : "");
}

std::string quote(std::string_view text) {
    constexpr std::size_t k_longest = 40;
    return fmt::format("'{}'", printable(text, k_longest));
}

bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

std::string_view take_word(std::string_view& line) {
    std::size_t begin = 0;
    while (begin < line.size() && is_space(line[begin])) ++begin;
    std::size_t end = begin;
    while (end < line.size() && !is_space(line[end])) ++end;
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

namespace {

/// Removes a leading plus sign, which from_chars does not accept.
std::string_view without_plus(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
}

/// Returns zero or infinity for a well-formed number that is too small or too large for a float.
float clamped_number(std::string_view word) {
    const bool negative = word.front() == '-';
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc()) return static_cast<float>(value);
    // The number is beyond doubles, too; the sign of its exponent tells whether it is small.
    const std::size_t exponent = word.find_first_of("eE");
    const bool small = exponent != std::string_view::npos ? word.substr(exponent + 1).starts_with('-')
                                                          : word.find_first_not_of("-0") == word.find('.');
    const float magnitude = small ? 0.0f : std::numeric_limits<float>::infinity();
    return negative ? -magnitude : magnitude;
}

bool is_halfway_between_floats(double value) {
    constexpr std::uint64_t k_below_float = (std::uint64_t{1} << 29) - 1, k_halfway = std::uint64_t{1} << 28;
    return (std::bit_cast<std::uint64_t>(value) & k_below_float) == k_halfway;
}

}  // namespace

std::optional<float> parse_float(std::string_view word) {
    word = without_plus(word);
    float value = 0;
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    if (end != last || word.empty()) return std::nullopt;
    if (error == std::errc::result_out_of_range) return clamped_number(word);
    if (error != std::errc()) return std::nullopt;
    return value;
}

std::optional<double> parse_number(std::string_view word) {
    double value = 0;
    const std::string_view digits = without_plus(word);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const double magnitude = std::abs(value);
    const bool is_float = error == std::errc() && end == digits.data() + digits.size() &&
                          magnitude >= std::numeric_limits<float>::min() &&
                          magnitude < double{std::numeric_limits<float>::max()};
    if (is_float && !is_halfway_between_floats(value)) return value;
    const std::optional<float> rounded = parse_float(word);
    if (!rounded || !is_float) return rounded;
    // Digits that the double does not hold may decide to which float it is rounded.
    return static_cast<float>(value) == *rounded ? value : std::nextafter(value, double{*rounded});
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
    word = without_plus(word);
    std::int64_t value = 0;
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    if (error != std::errc() || end != last) return std::nullopt;
    return value;
}

std::string_view without_mark(std::string_view text) {
    constexpr std::string_view k_mark = "\xef\xbb\xbf";
    if (text.starts_with(k_mark)) text.remove_prefix(k_mark.size());
    return text;
}

void refuse_utf16(std::string_view text, const std::string& name) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) fail(name, "is text in UTF-16; save it as UTF-8");
}

TextCursor::TextCursor(std::string_view text, std::string name, char comment)
    : text_(text), name_(std::move(name)), comment_(comment) {
    next_ = text_.size() - without_mark(text_).size();
    const bool old_mac = text_.find('\n') == std::string_view::npos && text_.find('\r') != std::string_view::npos;
    line_end_ = old_mac ? '\r' : '\n';
}

void TextCursor::jump(std::size_t offset, std::size_t line_number) {
    next_ = offset;
    line_number_ = line_number;
    line_ = {};
}

bool TextCursor::next_line() {
    while (next_ < text_.size()) {
        const std::size_t end = std::min(text_.find(line_end_, next_), text_.size());
        line_ = text_.substr(next_, end - next_);
        next_ = std::min(end + 1, text_.size());
        ++line_number_;
        if (comment_) line_ = line_.substr(0, line_.find(comment_));
        line_ = trimmed(line_);
        if (!line_.empty()) return true;
    }
    line_ = {};
    return false;
}

void TextCursor::need_line(std::string_view expected) {
    if (!next_line())
        fail(fmt::format("the file ends where {} should be; it is cut off or its counts are wrong", expected));
}

double TextCursor::number(std::string_view what) {
    const std::string_view taken = word();
    const auto value = parse_number(taken);
    if (!value) fail_word(taken, what, "a number");
    return *value;
}

std::int64_t TextCursor::integer(std::string_view what) {
    const std::string_view taken = word();
    const auto value = parse_integer(taken);
    if (!value) fail_word(taken, what, "an integer");
    return *value;
}

void TextCursor::fail(const std::string& message) const {
    mesh_io::fail(fmt::format("{}:{}", name_, line_number_), message);
}

void TextCursor::fail_word(std::string_view word, std::string_view what, std::string_view kind) const {
    if (word.empty()) fail(fmt::format("{} is missing at the end of the line", what));
    fail(fmt::format("{} should be {}, not {}", what, kind, quote(word)));
}

}  // namespace exemplar::mesh_io
