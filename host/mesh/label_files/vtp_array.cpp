// Arrays of VTK's XML formats: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#include "host/mesh/label_files/vtp_array.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/mesh/io/io_text.h"
#include "host/mesh/label_files/label_formats.h"

namespace exemplar::label_files {
namespace {

struct VtkType {
    std::string_view name;
    std::size_t bytes;
    char kind;  ///< i, u or f
};
constexpr std::array<VtkType, 10> k_vtk_types{{{"Int8", 1, 'i'},
                                               {"UInt8", 1, 'u'},
                                               {"Int16", 2, 'i'},
                                               {"UInt16", 2, 'u'},
                                               {"Int32", 4, 'i'},
                                               {"UInt32", 4, 'u'},
                                               {"Int64", 8, 'i'},
                                               {"UInt64", 8, 'u'},
                                               {"Float32", 4, 'f'},
                                               {"Float64", 8, 'f'}}};

/// The bytes of an array, one after the other: raw, or decoded from base64 as they are asked for.
class VtkBytes {
  public:
    VtkBytes(std::string_view text, bool is_raw, std::string what)
        : text_(text), is_raw_(is_raw), what_(std::move(what)) {}

    /// Returns the next `count` bytes; throws if there are fewer.
    std::string take(std::uint64_t count) {
        if (count > text_.size() + held_.size()) fail_short();
        if (!is_raw_)
            while (held_.size() < count) decode_group();
        std::string taken;
        if (is_raw_) {
            taken = text_.substr(0, count);
            text_.remove_prefix(count);
        } else {
            taken = held_.substr(0, count);
            held_.erase(0, count);
        }
        return taken;
    }
    /// Continues at the next group of base64: the lengths of compressed blocks are encoded by themselves.
    void end_stream() { held_.clear(); }

  private:
    [[noreturn]] void fail_short() const { fail(what_, "ends before its array; the file is cut off"); }

    static int value_of(char c) {
        constexpr std::string_view k_alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        const std::size_t at = k_alphabet.find(c);
        return at == std::string_view::npos ? -1 : static_cast<int>(at);
    }
    /// Decodes four characters; a group that ends with = holds fewer than three bytes.
    void decode_group() {
        std::uint32_t bits = 0;
        int characters = 0, padding = 0;
        while (characters + padding < 4) {
            if (text_.empty()) fail_short();
            const char c = text_.front();
            text_.remove_prefix(1);
            if (mesh_io::is_space(c)) continue;
            const int value = value_of(c);
            if (value < 0 && (c != '=' || characters < 2)) fail(what_, "is no base64");
            if (value >= 0 && padding > 0) fail(what_, "is no base64");
            bits = bits << 6 | static_cast<std::uint32_t>(std::max(value, 0));
            value < 0 ? ++padding : ++characters;
        }
        for (int i = 0; i < 3 - padding; ++i) held_ += static_cast<char>(bits >> (16 - 8 * i) & 0xffU);
    }

    std::string_view text_;
    bool is_raw_;
    std::string what_, held_;
};

std::uint64_t length_of(const std::string& bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + at, size);
    return value;
}

/// Inflates the blocks of a compressed array of `expected` bytes.
std::string inflate_blocks(VtkBytes& source, std::size_t header_bytes, std::uint64_t expected,
                           const std::string& what) {
    const std::string lengths = source.take(3 * header_bytes);
    const std::uint64_t blocks = length_of(lengths, 0, header_bytes),
                        block = length_of(lengths, header_bytes, header_bytes),
                        last = length_of(lengths, 2 * header_bytes, header_bytes);
    const std::uint64_t full = last == 0 ? blocks : blocks - 1;
    if (blocks == 0 || blocks > expected || block == 0 || block > expected + 1 || last > block ||
        full * block + last != expected)
        if (!(blocks == 1 && last == expected))  // a block may be larger than the array
            fail(what, fmt::format("has blocks of another size than its {} bytes", expected));
    const std::string sizes = source.take(blocks * header_bytes);
    source.end_stream();
    std::string bytes;
    bytes.reserve(expected);
    for (std::uint64_t i = 0; i < blocks; ++i) {
        const std::string packed = source.take(length_of(sizes, i * header_bytes, header_bytes));
        const std::uint64_t size = i + 1 == blocks && last > 0 ? last : block;
        std::string plain(size, '\0');
        auto plain_bytes = static_cast<uLongf>(size);
        const int status = uncompress(reinterpret_cast<Bytef*>(plain.data()), &plain_bytes,
                                      reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
        if (status != Z_OK || plain_bytes != size) fail(what, fmt::format("block {} is damaged", i));
        bytes += plain;
    }
    return bytes;
}

std::int64_t integer_of(const std::string& bytes, std::size_t at, const VtkType& type, const std::string& what) {
    if (type.kind == 'f') {
        float single = 0;
        double value = 0;
        if (type.bytes == 4)
            std::memcpy(&single, bytes.data() + at, 4), value = double{single};
        else
            std::memcpy(&value, bytes.data() + at, 8);
        if (!(std::abs(value) <= 1e9) || value != std::floor(value))
            fail(what, fmt::format("{} is no label number", value));
        return static_cast<std::int64_t>(value);
    }
    const std::size_t unused = 64 - 8 * type.bytes;
    const std::uint64_t value = length_of(bytes, at, type.bytes) << unused;
    return type.kind == 'i' ? static_cast<std::int64_t>(value) >> unused : static_cast<std::int64_t>(value >> unused);
}

std::vector<std::int64_t> ascii_integers(std::string_view text, std::size_t count, const std::string& what) {
    std::vector<std::int64_t> numbers;
    for (std::string_view word = mesh_io::take_word(text); !word.empty(); word = mesh_io::take_word(text)) {
        const auto value = mesh_io::parse_number(word);
        if (!value || !(std::abs(*value) <= 1e9) || *value != std::floor(*value))
            fail(what, fmt::format("a label number is expected, not {}", mesh_io::quote(word)));
        if (numbers.size() == count) fail(what, fmt::format("has more than {} values", count));
        numbers.push_back(static_cast<std::int64_t>(*value));
    }
    if (numbers.size() != count) fail(what, fmt::format("has {} values, not {}", numbers.size(), count));
    return numbers;
}

}  // namespace

std::vector<std::int64_t> vtk_integers(const VtkArray& array, const VtkEncoding& encoding, std::size_t count,
                                       const std::string& name) {
    const std::string what = fmt::format("{}: array {}", name, mesh_io::quote(array.name));
    if (array.format == "ascii") return ascii_integers(array.text, count, what);
    const auto type = std::find_if(k_vtk_types.begin(), k_vtk_types.end(),
                                   [&](const VtkType& each) { return each.name == array.type; });
    if (type == k_vtk_types.end()) fail(what, fmt::format("is of type {}, not of numbers", mesh_io::quote(array.type)));
    const bool is_appended = array.format == "appended";
    if (!is_appended && array.format != "binary")
        fail(what, fmt::format("has the unknown format {}", mesh_io::quote(array.format)));
    if (is_appended && array.offset > encoding.appended.size()) fail(what, "begins behind the end of the file");
    VtkBytes source(is_appended ? encoding.appended.substr(array.offset) : std::string_view(array.text),
                    is_appended && encoding.appended_is_raw, what);
    const std::uint64_t expected = std::uint64_t{count} * type->bytes;
    std::string bytes;
    if (encoding.is_compressed) {
        bytes = inflate_blocks(source, encoding.header_bytes, expected, what);
    } else {
        const std::uint64_t length = length_of(source.take(encoding.header_bytes), 0, encoding.header_bytes);
        if (length != expected)
            fail(what, fmt::format("has {} bytes, not {} values of {}", length, count, type->bytes));
        bytes = source.take(length);
    }
    std::vector<std::int64_t> numbers;
    numbers.reserve(count);
    for (std::size_t i = 0; i < count; ++i) numbers.push_back(integer_of(bytes, i * type->bytes, *type, what));
    return numbers;
}

}  // namespace exemplar::label_files
