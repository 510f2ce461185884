#include "host/imaging/pictures/group4.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace exemplar {
namespace {

constexpr std::uint32_t k_run_bits = 13;  ///< of the longest code of a run
constexpr std::uint32_t k_mode_bits = 7;  ///< of the longest code of a mode

// The codes of runs (T.4, tables 2 and 3): of 0 to 63 pixels, which end a run; then of 64, 128, ... 1728 pixels, after
// which more of the run follows.
constexpr std::string_view k_white_runs =
    "00110101 000111 0111 1000 1011 1100 1110 1111 10011 10100 00111 01000 001000 000011 110100 110101 "
    "101010 101011 0100111 0001100 0001000 0010111 0000011 0000100 0101000 0101011 0010011 0100100 0011000 00000010 "
    "00000011 00011010 00011011 00010010 00010011 00010100 00010101 00010110 00010111 00101000 00101001 00101010 "
    "00101011 00101100 00101101 00000100 00000101 00001010 00001011 01010010 01010011 01010100 01010101 00100100 "
    "00100101 01011000 01011001 01011010 01011011 01001010 01001011 00110010 00110011 00110100 "
    "11011 10010 010111 0110111 00110110 00110111 01100100 01100101 01101000 01100111 011001100 011001101 011010010 "
    "011010011 011010100 011010101 011010110 011010111 011011000 011011001 011011010 011011011 010011000 010011001 "
    "010011010 011000 010011011 ";
constexpr std::string_view k_black_runs =
    "0000110111 010 11 10 011 0011 0010 00011 000101 000100 0000100 0000101 0000111 00000100 00000111 000011000 "
    "0000010111 0000011000 0000001000 00001100111 00001101000 00001101100 00000110111 00000101000 00000010111 "
    "00000011000 000011001010 000011001011 000011001100 000011001101 000001101000 000001101001 000001101010 "
    "000001101011 000011010010 000011010011 000011010100 000011010101 000011010110 000011010111 000001101100 "
    "000001101101 000011011010 000011011011 000001010100 000001010101 000001010110 000001010111 000001100100 "
    "000001100101 000001010010 000001010011 000000100100 000000110111 000000111000 000000100111 000000101000 "
    "000001011000 000001011001 000000101011 000000101100 000001011010 000001100110 000001100111 "
    "0000001111 000011001000 000011001001 000001011011 000000110011 000000110100 000000110101 0000001101100 "
    "0000001101101 0000001001010 0000001001011 0000001001100 0000001001101 0000001110010 0000001110011 0000001110100 "
    "0000001110101 0000001110110 0000001110111 0000001010010 0000001010011 0000001010100 0000001010101 0000001011010 "
    "0000001011011 0000001100100 0000001100101 ";
// Codes for 1792, 1856, ... 2560 pixels, the same for both colors. Another code of the same color adds the rest of the
// run.
constexpr std::string_view k_long_runs =
    "00000001000 00000001100 00000001101 000000010010 000000010011 000000010100 000000010101 000000010110 000000010111 "
    "000000011100 000000011101 000000011110 000000011111 ";

enum class FaxMode : std::uint8_t { invalid, pass, horizontal, vertical };

/// A decoded run: how many pixels it has, and how many bits its code has; 0 bits: no code begins with the bits read.
struct FaxRun {
    std::uint16_t pixels = 0;
    std::uint8_t bits = 0;
};
struct FaxStep {
    FaxMode mode = FaxMode::invalid;
    std::int8_t offset = 0;  ///< of a vertical step: pixels to the right of the change above
    std::uint8_t bits = 0;
};

/// Sets all entries of a table, which the next `table_bits` bits index, that begin with a code.
template <typename Table, typename Entry>
void enter_code(Table& table, std::uint32_t table_bits, std::string_view code, Entry entry) {
    std::uint32_t value = 0;
    for (const char bit : code) value = value << 1 | (bit == '1' ? 1U : 0U);
    const auto free = table_bits - static_cast<std::uint32_t>(code.size());
    entry.bits = static_cast<std::uint8_t>(code.size());
    for (std::uint32_t i = 0; i < 1U << free; ++i) table[value << free | i] = entry;
}

using FaxRuns = std::array<FaxRun, 1U << k_run_bits>;

/// Enters codes, each followed by a space; of 64 runs of 0 to 63 pixels first unless `longer_than` is given, then of
/// multiples of 64.
void enter_runs(FaxRuns& table, std::string_view codes, std::uint32_t first) {
    for (std::uint32_t i = first; !codes.empty(); ++i) {
        const std::size_t size = codes.find(' ');
        const std::uint32_t pixels = i < 64 ? i : 64 * (i - 63);
        enter_code(table, k_run_bits, codes.substr(0, size), FaxRun{static_cast<std::uint16_t>(pixels), 0});
        codes.remove_prefix(size + 1);
    }
}

/// Returns the codes of runs of white (0) or black (1).
const FaxRuns& fax_runs(bool black) {
    static const std::array<FaxRuns, 2> tables = [] {
        std::array<FaxRuns, 2> out{};
        enter_runs(out[0], k_white_runs, 0);
        enter_runs(out[1], k_black_runs, 0);
        constexpr std::uint32_t k_first_long = 63 + 1792 / 64;
        for (FaxRuns& table : out) enter_runs(table, k_long_runs, k_first_long);
        return out;
    }();
    return tables[black ? 1 : 0];
}

using FaxSteps = std::array<FaxStep, 1U << k_mode_bits>;

const FaxSteps& fax_steps() {
    static const FaxSteps steps = [] {
        FaxSteps out{};
        enter_code(out, k_mode_bits, "0001", FaxStep{FaxMode::pass, 0, 0});
        enter_code(out, k_mode_bits, "001", FaxStep{FaxMode::horizontal, 0, 0});
        constexpr std::array<std::string_view, 7> k_vertical{"0000010", "000010", "010",    "1",
                                                             "011",     "000011", "0000011"};
        for (std::size_t i = 0; i < k_vertical.size(); ++i)
            enter_code(out, k_mode_bits, k_vertical[i],
                       FaxStep{FaxMode::vertical, static_cast<std::int8_t>(static_cast<int>(i) - 3), 0});
        return out;
    }();
    return steps;
}

/// Reads bits, the high one first; zeros beyond the end.
class FaxBits {
  public:
    explicit FaxBits(std::string_view bytes) : bytes_(bytes) {}
    std::uint32_t peek(std::uint32_t count) const {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t at = place_ / 8 + i;
            value = value << 8 | (at < bytes_.size() ? static_cast<std::uint8_t>(bytes_[at]) : 0U);
        }
        return value << place_ % 8 >> (32 - count);
    }
    void skip(std::uint32_t count) { place_ += count; }
    bool ended() const { return place_ > 8 * bytes_.size(); }

  private:
    std::string_view bytes_;
    std::size_t place_ = 0;
};

/// Decodes rows. A row is the places where its color changes, from white first; each is told by those of the row
/// before.
class FaxRows {
  public:
    FaxRows(std::string_view bytes, std::uint32_t width) : bits_(bytes), width_(width), above_{width, width, width} {}

    /// Decodes the next row; returns its changes, the last ones at `width`, or none if the bytes are not valid.
    const std::vector<std::uint32_t>* next() {
        row_.clear();
        place_ = 0;
        at_ = 0;
        begun_ = false;
        while (place_ < width_)
            if (!step()) return nullptr;
        row_.insert(row_.end(), 3, width_);
        row_.swap(above_);
        return &above_;
    }

  private:
    bool black() const { return row_.size() % 2 == 1; }

    /// Finds the first change above that is beyond the current place, to the color that is not the current one.
    void find_change_above() {
        while (at_ > 0 && above_[at_ - 1] > place_) --at_;
        while (above_[at_] < width_ && (above_[at_] < place_ || (above_[at_] == place_ && begun_))) ++at_;
        if (at_ % 2 != (black() ? 1U : 0U)) ++at_;
    }

    bool step() {
        const FaxStep step = fax_steps()[bits_.peek(k_mode_bits)];
        bits_.skip(step.bits);
        if (step.mode == FaxMode::invalid || bits_.ended()) return false;
        if (step.mode == FaxMode::horizontal) return run() && run();
        find_change_above();
        const std::uint32_t change = above_[at_];
        if (step.mode == FaxMode::pass) {
            place_ = above_[at_ + 1];
            begun_ = true;
            return true;
        }
        const auto to = static_cast<std::int64_t>(change) + step.offset;
        if (to < static_cast<std::int64_t>(place_) + (begun_ ? 1 : 0) || to > width_) return false;
        change_at(static_cast<std::uint32_t>(to));
        return true;
    }

    /// Reads a run of the current color.
    bool run() {
        const FaxRuns& runs = fax_runs(black());
        std::uint32_t pixels = 0;
        for (std::uint32_t last = 64; last >= 64; pixels += last) {
            const FaxRun code = runs[bits_.peek(k_run_bits)];
            bits_.skip(code.bits);
            if (code.bits == 0 || bits_.ended()) return false;
            last = code.pixels;
            if (pixels + last > width_ - place_) return false;
        }
        change_at(place_ + pixels);
        return true;
    }

    void change_at(std::uint32_t place) {
        row_.push_back(place);
        place_ = place;
        begun_ = true;
    }

    FaxBits bits_;
    std::uint32_t width_;
    std::vector<std::uint32_t> above_, row_;
    std::uint32_t place_ = 0;
    std::size_t at_ = 0;  ///< in above_
    bool begun_ = false;  ///< before, the current place is left of the row
};

/// Sets bits of a row.
void blacken(std::span<std::uint8_t> row, std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t x = from; x < to;) {
        if (x % 8 == 0 && to - x >= 8) {
            row[x / 8] = 0xff;
            x += 8;
        } else {
            row[x / 8] |= static_cast<std::uint8_t>(0x80 >> x % 8);
            ++x;
        }
    }
}

}  // namespace

bool unpack_group4(std::string_view bytes, std::uint32_t width, std::span<std::uint8_t> out) {
    FaxRows rows(bytes, width);
    const std::size_t row_bytes = (std::size_t{width} + 7) / 8;
    for (std::size_t at = 0; at + row_bytes <= out.size(); at += row_bytes) {
        const std::vector<std::uint32_t>* changes = rows.next();
        if (!changes) return false;
        for (std::size_t i = 0; i + 1 < changes->size(); i += 2)
            blacken(out.subspan(at, row_bytes), (*changes)[i], (*changes)[i + 1]);
    }
    return true;
}

}  // namespace exemplar
