#include "apps/bench/spirv/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr std::uint64_t k_seed_of_inputs = 1;

template <typename T>
std::optional<T> parsed_number(std::string_view text, int base = 10) {
    T value{};
    std::from_chars_result result{};
    if constexpr (std::is_floating_point_v<T>)
        result = std::from_chars(text.data(), text.data() + text.size(), value);
    else
        result = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size() || text.empty()) return std::nullopt;
    return value;
}

template <typename T>
std::optional<T> parsed_integer(std::string_view text) {
    if (text.starts_with("0x") || text.starts_with("0X")) return parsed_number<T>(text.substr(2), 16);
    return parsed_number<T>(text);
}

std::vector<std::string> split_at_commas(const std::string& text) {
    std::vector<std::string> parts(1);
    for (const char letter : text)
        if (letter == ',')
            parts.emplace_back();
        else
            parts.back() += letter;
    return parts;
}

// Splits "N=TEXT".
std::pair<std::uint32_t, std::string> numbered_text(const std::string& option, const std::string& text,
                                                    std::string_view form) {
    const std::size_t equals = text.find('=');
    const auto number = parsed_number<std::uint32_t>(std::string_view(text).substr(0, std::min(equals, text.size())));
    if (equals == std::string::npos || !number || equals + 1 == text.size())
        throw UsageError(fmt::format("{} '{}' must be {}", option, text, form));
    return {*number, text.substr(equals + 1)};
}

template <typename T>
Bytes bytes_of_values(const std::vector<T>& values) {
    Bytes bytes(values.size() * sizeof(T));
    if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

// Random floats differ between bindings, but not between runs.
Bytes random_floats(std::uint64_t count, std::uint32_t binding) {
    Random random(k_seed_of_inputs + binding);
    std::vector<float> values(count);
    for (float& value : values) value = static_cast<float>(random.next() >> 40) * 0x1.0p-24f;
    return bytes_of_values(values);
}

// Returns the array of a NumPy file: magic, version, length of the header, header, values.
std::string_view npy_values(const std::filesystem::path& path, std::string_view content) {
    const auto refuse = [&](std::string_view why) { throw DataError(fmt::format("{}: {}", path.string(), why)); };
    constexpr std::size_t k_start = 12;
    if (content.size() < k_start || !content.starts_with("\x93NUMPY"))
        refuse("this is no .npy file; give it another name if its bytes are meant");
    const auto byte = [&](std::size_t i) { return std::size_t{static_cast<unsigned char>(content[i])}; };
    const bool is_long = byte(6) > 1;
    const std::size_t begin = is_long ? 12 : 10;
    const std::size_t length = byte(8) + (byte(9) << 8) + (is_long ? (byte(10) << 16) + (byte(11) << 24) : 0);
    if (length > content.size() - begin) refuse("its header is truncated; write it again");
    const std::string_view header = content.substr(begin, length);
    if (header.find("'fortran_order': False") == std::string_view::npos)
        refuse("its array is in Fortran's order; write it with numpy.ascontiguousarray");
    if (header.find("'>") != std::string_view::npos || header.find("'|O") != std::string_view::npos)
        refuse("its numbers are big-endian, or are objects; write float32, int32 or uint32");
    return content.substr(begin + length);
}

std::string_view name_of(const ReflectedBinding& binding) {
    return binding.name.empty() ? std::string_view("unnamed") : std::string_view(binding.name);
}

}  // namespace

std::uint64_t parse_count(const std::string& option, const std::string& text) {
    std::string_view digits = text;
    unsigned shift = 0;
    constexpr std::string_view k_suffixes = "KMG";
    if (const std::size_t suffix = digits.empty() ? std::string_view::npos : k_suffixes.find(digits.back());
        suffix != std::string_view::npos) {
        shift = static_cast<unsigned>(10 * (suffix + 1));
        digits.remove_suffix(1);
    }
    const auto number = parsed_number<std::uint64_t>(digits);
    if (!number || *number > std::numeric_limits<std::uint64_t>::max() >> 8 >> shift)
        throw UsageError(fmt::format("{}: '{}' is no whole number, such as 4096 or 4M", option, text));
    return *number << shift;
}

std::array<std::uint64_t, 3> parse_box(const std::string& option, const std::string& text) {
    std::array<std::uint64_t, 3> box{1, 1, 1};
    const std::vector<std::string> parts = split_at_commas(text);
    if (parts.size() > box.size())
        throw UsageError(fmt::format("{} '{}' has {} numbers; give up to three: X,Y,Z", option, text, parts.size()));
    for (std::size_t axis = 0; axis < parts.size(); ++axis) {
        box[axis] = parse_count(option, parts[axis]);
        if (box[axis] == 0 || box[axis] > std::numeric_limits<std::uint32_t>::max())
            throw UsageError(fmt::format("{} '{}': each number must be from 1 to 4294967295", option, text));
    }
    return box;
}

BindingSource parse_binding(const std::string& option, const std::string& text) {
    const auto [binding, rest] =
        numbered_text(option, text, "N=FILE, N=:BYTES, N=random:COUNT or N=count:COUNT with N a binding's number");
    BindingSource source{.binding = binding, .kind = BindingSource::Kind::file, .path = rest, .number = 0};
    const std::array<std::pair<std::string_view, BindingSource::Kind>, 3> kinds{
        {{":", BindingSource::Kind::zeros},
         {"random:", BindingSource::Kind::random},
         {"count:", BindingSource::Kind::count}}};
    for (const auto& [start, kind] : kinds)
        if (rest.starts_with(start)) {
            source.kind = kind;
            source.path.clear();
            source.number = parse_count(fmt::format("{} {}", option, text), rest.substr(start.size()));
        }
    return source;
}

ConstantText parse_constant(const std::string& option, const std::string& text) {
    auto [id, value] = numbered_text(option, text, "ID=VALUE with the constant_id of a specialization constant");
    return {id, std::move(value)};
}

Bytes read_values(const std::filesystem::path& path) {
    const std::string content = read_file(path);
    const std::string_view values = path.extension() == ".npy" ? npy_values(path, content) : content;
    const auto raw = std::as_bytes(std::span(values));
    return {raw.begin(), raw.end()};
}

Bytes contents_of(const BindingSource& source) {
    switch (source.kind) {
        case BindingSource::Kind::file:
            return read_values(source.path);
        case BindingSource::Kind::zeros:
            return Bytes(source.number);
        case BindingSource::Kind::random:
            return random_floats(source.number, source.binding);
        case BindingSource::Kind::count:
            break;
    }
    std::vector<std::uint32_t> values(source.number);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint32_t>(i);
    return bytes_of_values(values);
}

Bytes default_contents(const ReflectedBinding& binding, const BlockScalars* scalars, std::uint64_t threads) {
    if (!scalars)  // texels
        return binding.integers ? Bytes(threads * binding.stride)
                                : random_floats(threads * binding.stride / sizeof(float), binding.binding);
    const std::uint64_t elements = scalars->fixed_count > 0 ? scalars->fixed_count : threads;
    const std::uint64_t bytes = scalars->head_bytes + scalars->stride * elements;
    const auto is_float = [](const ReflectedScalar& scalar) { return scalar.type == ScalarType::float32; };
    const bool floats = binding.reads && scalars->complete && !(scalars->head.empty() && scalars->element.empty()) &&
                        std::ranges::all_of(scalars->head, is_float) && std::ranges::all_of(scalars->element, is_float);
    return floats ? random_floats(bytes / sizeof(float), binding.binding) : Bytes(bytes);
}

void check_contents(const ReflectedBinding& binding, const BlockScalars* scalars, const BindingSource& source,
                    std::size_t bytes) {
    const std::string given =
        source.kind == BindingSource::Kind::file ? source.path.string() : std::string("what is given");
    const std::string start = fmt::format("--bind {}: {} has {} bytes, ", binding.binding, given, bytes);
    const std::size_t min_bytes = scalars ? scalars->min_bytes() : binding.stride;
    if (bytes < min_bytes)
        throw UsageError(fmt::format("{}and binding {} '{}' of the shader needs at least {}; give more", start,
                                     binding.binding, name_of(binding), min_bytes));
    const std::size_t head = scalars ? scalars->head_bytes : 0, stride = scalars ? scalars->stride : binding.stride;
    if (stride > 0 && (bytes - head) % stride != 0)
        throw UsageError(fmt::format("{}no whole number of elements of {} bytes{} as binding {} '{}' has them", start,
                                     stride, head > 0 ? fmt::format(" behind {}", head) : "", binding.binding,
                                     name_of(binding)));
}

std::optional<std::uint32_t> scalar_bits(const std::string& text, ScalarType type) {
    if (type == ScalarType::boolean) {
        if (text == "true" || text == "1") return 1u;
        if (text == "false" || text == "0") return 0u;
        return std::nullopt;
    }
    if (type == ScalarType::float32)
        if (const auto value = parsed_number<float>(text)) return std::bit_cast<std::uint32_t>(*value);
    if (type == ScalarType::int32)
        if (const auto value = parsed_integer<std::int32_t>(text)) return std::bit_cast<std::uint32_t>(*value);
    if (type == ScalarType::uint32) return parsed_integer<std::uint32_t>(text);
    return std::nullopt;
}

Bytes push_bytes(const std::string& text, const std::vector<ReflectedScalar>& members, std::size_t bytes) {
    std::string list;
    for (const ReflectedScalar& member : members)
        list += fmt::format("{}{} {}", list.empty() ? "" : ", ", to_string(member.type), member.name);
    if (members.empty()) {
        if (text.empty()) return {};
        throw UsageError(fmt::format("--push {}: the shader has no push constants; leave it out", text));
    }
    if (text.empty()) throw UsageError(fmt::format("the shader has push constants; give --push with: {}", list));
    const std::vector<std::string> values = split_at_commas(text);
    if (values.size() != members.size())
        throw UsageError(fmt::format("--push {} has {} numbers, and the shader's push constants are {}: {}", text,
                                     values.size(), members.size(), list));
    Bytes result((bytes + 3) / 4 * 4);
    for (std::size_t i = 0; i < members.size(); ++i) {
        const auto bits = scalar_bits(values[i], members[i].type);
        if (!bits || members[i].offset + sizeof *bits > result.size())
            throw UsageError(fmt::format("--push {}: '{}' cannot be the value of '{}', which is {}", text, values[i],
                                         members[i].name, to_string(members[i].type)));
        std::memcpy(result.data() + members[i].offset, &*bits, sizeof *bits);
    }
    return result;
}

std::pair<std::uint32_t, std::uint32_t> constant_bits(const std::string& option, const ConstantText& constant,
                                                      const std::vector<ReflectedConstant>& constants) {
    const auto found = std::ranges::find(constants, constant.id, &ReflectedConstant::id);
    if (found == constants.end()) {
        std::string list;
        for (const ReflectedConstant& one : constants)
            list += fmt::format("{}{} ({} {})", list.empty() ? "" : ", ", one.id, to_string(one.type), one.name);
        throw UsageError(fmt::format("{} {}={}: the shader has no specialization constant {}; it has {}", option,
                                     constant.id, constant.value, constant.id, list.empty() ? "none" : list));
    }
    const auto bits = scalar_bits(constant.value, found->type);
    if (!bits)
        throw UsageError(fmt::format("{} {}={}: '{}' is no value of '{}', which is {}", option, constant.id,
                                     constant.value, constant.value, found->name, to_string(found->type)));
    return {constant.id, *bits};
}

}  // namespace exemplar
