#include "apps/bench/spirv/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include "host/core/half.h"

namespace exemplar {
namespace {

constexpr double k_infinite_difference = std::numeric_limits<double>::infinity();

double float_difference(double actual, double expected) {
    if (actual == expected || (std::isnan(actual) && std::isnan(expected))) return 0;
    const double apart = std::abs(actual - expected);
    return std::isfinite(apart) ? apart / std::max(1.0, std::abs(expected)) : k_infinite_difference;
}

// The number at a place, exactly.
double number_at(const std::byte* place, ScalarType type) {
    const auto read = [&]<typename T>(T value) {
        std::memcpy(&value, place, sizeof value);
        return value;
    };
    switch (type) {
        case ScalarType::float16:
            return static_cast<double>(from_half({read(std::uint16_t{})}));
        case ScalarType::float32:
            return static_cast<double>(read(float{}));
        case ScalarType::float64:
            return read(double{});
        case ScalarType::int32:
            return static_cast<double>(read(std::int32_t{}));
        default:
            return static_cast<double>(read(std::uint32_t{}));
    }
}

bool is_floating(ScalarType type) {
    return type == ScalarType::float16 || type == ScalarType::float32 || type == ScalarType::float64;
}

double scalar_difference(double actual, double expected, ScalarType type) {
    if (is_floating(type)) return float_difference(actual, expected);
    if (actual == expected) return 0;
    return type == ScalarType::other ? k_infinite_difference : std::abs(actual - expected);
}

std::string scalar_text(double number, ScalarType type) {
    if (type == ScalarType::float32) return fmt::format("{}", static_cast<float>(number));
    if (type == ScalarType::other) return fmt::format("{:#010x}", static_cast<std::uint32_t>(number));
    return fmt::format("{}", number);
}

// Compares numbers one after the other, and keeps the worst.
class Comparer {
  public:
    Comparer(std::span<const std::byte> actual, std::span<const std::byte> expected, double tolerance)
        : actual_(actual), expected_(expected), tolerance_(tolerance) {}

    template <typename Place>
    void compare(std::size_t offset, ScalarType type, Place&& place) {
        const std::size_t bytes = type == ScalarType::other ? 4 : bytes_of(type);
        if (offset + bytes > actual_.size()) return;
        const double a = number_at(actual_.data() + offset, type), b = number_at(expected_.data() + offset, type);
        const double apart = scalar_difference(a, b, type);
        ++result_.numbers;
        result_.differing += apart > tolerance_;
        if (apart <= result_.largest) return;
        result_.largest = apart;
        result_.place = place();
        result_.actual = scalar_text(a, type);
        result_.expected = scalar_text(b, type);
    }

    BufferComparison result() && { return std::move(result_); }

  private:
    std::span<const std::byte> actual_, expected_;
    double tolerance_;
    BufferComparison result_;
};

std::string element_place(std::size_t index, const std::string& name) {
    return fmt::format("element {}{}{}", index, name.empty() || name.starts_with('[') ? "" : ".", name);
}

}  // namespace

BufferComparison compare_buffers(std::span<const std::byte> actual, std::span<const std::byte> expected,
                                 const BlockScalars& scalars, double tolerance) {
    Comparer comparer(actual, expected, tolerance);
    if (!scalars.complete) {
        for (std::size_t at = 0; at + 4 <= actual.size(); at += 4)
            comparer.compare(at, ScalarType::other, [&] { return fmt::format("byte {}", at); });
        return std::move(comparer).result();
    }
    for (const ReflectedScalar& scalar : scalars.head)
        comparer.compare(scalar.offset, scalar.type, [&] { return scalar.name; });
    if (scalars.stride == 0) return std::move(comparer).result();
    for (std::size_t i = 0, at = scalars.head_bytes; at < actual.size(); ++i, at += scalars.stride)
        for (const ReflectedScalar& scalar : scalars.element)
            comparer.compare(at + scalar.offset, scalar.type, [&] { return element_place(i, scalar.name); });
    return std::move(comparer).result();
}

}  // namespace exemplar
