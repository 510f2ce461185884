#include "host/imaging/pictures/packed_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>

namespace exemplar {
namespace {

constexpr std::uint32_t k_lzw_restart = 256, k_lzw_end = 257, k_first_lzw_string = 258;
constexpr std::uint32_t k_lzw_codes = 4096;

/// The strings of LZW. Each is an earlier one and a byte, and stands in the output already, where it was made.
class LzwStrings {
  public:
    void clear() { count_ = k_first_lzw_string; }
    std::uint32_t count() const { return count_; }
    bool full() const { return count_ == k_lzw_codes; }
    /// Codes become longer one string before their number needs it, as TIFF has it.
    std::uint32_t code_bits() const {
        std::uint32_t bits = 9;
        while (bits < 12 && count_ + 1 >= 1U << bits) ++bits;
        return bits;
    }
    void add(std::size_t start, std::size_t length) { strings_[count_++] = {start, length}; }
    std::size_t start(std::uint32_t code) const { return strings_[code].start; }
    std::size_t length(std::uint32_t code) const { return code < 256 ? 1 : strings_[code].length; }

  private:
    struct Place {
        std::size_t start = 0, length = 0;
    };
    std::array<Place, k_lzw_codes> strings_{};
    std::uint32_t count_ = k_first_lzw_string;
};

/// Reads codes of growing length from bytes, the high bit first.
class LzwCodes {
  public:
    explicit LzwCodes(std::string_view bytes) : bytes_(bytes) {}
    std::optional<std::uint32_t> next(std::uint32_t bits) {
        while (held_ < bits) {
            if (at_ == bytes_.size()) return std::nullopt;
            value_ = value_ << 8 | static_cast<std::uint8_t>(bytes_[at_++]);
            held_ += 8;
        }
        held_ -= bits;
        return value_ >> held_ & ((1U << bits) - 1);
    }

  private:
    std::string_view bytes_;
    std::size_t at_ = 0;
    std::uint32_t value_ = 0, held_ = 0;
};

}  // namespace

bool unpack_bits(std::string_view bytes, std::span<std::uint8_t> out) {
    std::size_t at = 0, filled = 0;
    while (filled < out.size()) {
        if (at == bytes.size()) return false;
        const int head = static_cast<std::int8_t>(bytes[at++]);
        if (head == -128) continue;
        const std::size_t wanted = head >= 0 ? static_cast<std::size_t>(head) + 1 : static_cast<std::size_t>(1 - head);
        const std::size_t count = std::min(wanted, out.size() - filled), taken = head >= 0 ? count : 1;
        if (taken > bytes.size() - at) return false;
        for (std::size_t i = 0; i < count; ++i)
            out[filled++] = static_cast<std::uint8_t>(bytes[head >= 0 ? at + i : at]);
        at += taken;
    }
    return true;
}

bool unpack_lzw(std::string_view bytes, std::span<std::uint8_t> out) {
    LzwStrings strings;
    LzwCodes codes(bytes);
    std::size_t filled = 0, before = 0, length_before = 0;  // the string that was written last
    while (filled < out.size()) {
        const std::optional<std::uint32_t> code = codes.next(strings.code_bits());
        if (!code || *code == k_lzw_end) return false;
        if (*code == k_lzw_restart) {
            strings.clear();
            length_before = 0;
            continue;
        }
        // The string before and the first byte of this one make a new string, which this one may be.
        if (length_before > 0 && !strings.full()) strings.add(before, length_before + 1);
        if (*code >= strings.count()) return false;
        const std::size_t start = filled, length = std::min(strings.length(*code), out.size() - filled);
        if (*code < 256)
            out[filled++] = static_cast<std::uint8_t>(*code);
        else
            for (std::size_t i = 0; i < length; ++i) out[filled++] = out[strings.start(*code) + i];
        before = start;
        length_before = length;
    }
    return true;
}

bool unpack_deflate(std::string_view bytes, std::span<std::uint8_t> out) {
    constexpr std::size_t k_most = std::numeric_limits<uInt>::max();
    if (bytes.size() > k_most || out.size() > k_most) return false;
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) return false;
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast,cppcoreguidelines-pro-type-reinterpret-cast): zlib's types
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    const int result = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    // Rows below the page may follow, for which there is no place.
    return stream.avail_out == 0 && (result == Z_STREAM_END || result == Z_BUF_ERROR || result == Z_OK);
}

}  // namespace exemplar
