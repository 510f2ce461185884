#include "apps/bench/spirv/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace exemplar {
namespace {

constexpr double k_infinite_difference = std::numeric_limits<double>::infinity();

double float_difference(float actual, float expected) {
    if (actual == expected || (std::isnan(actual) && std::isnan(expected))) return 0;
    const double apart = std::abs(static_cast<double>(actual) - static_cast<double>(expected));
    return std::isfinite(apart) ? apart / std::max(1.0, std::abs(static_cast<double>(expected)))
                                : k_infinite_difference;
}

double scalar_difference(std::uint32_t actual, std::uint32_t expected, ScalarType type) {
    if (actual == expected) return 0;
    switch (type) {
        case ScalarType::float32:
            return float_difference(std::bit_cast<float>(actual), std::bit_cast<float>(expected));
        case ScalarType::int32:
            return std::abs(static_cast<double>(std::bit_cast<std::int32_t>(actual)) -
                            static_cast<double>(std::bit_cast<std::int32_t>(expected)));
        case ScalarType::uint32:
            return std::abs(static_cast<double>(actual) - static_cast<double>(expected));
        default:
            return k_infinite_difference;
    }
}

std::string scalar_text(std::uint32_t bits, ScalarType type) {
    switch (type) {
        case ScalarType::float32:
            return fmt::format("{}", std::bit_cast<float>(bits));
        case ScalarType::int32:
            return fmt::format("{}", std::bit_cast<std::int32_t>(bits));
        case ScalarType::uint32:
            return fmt::format("{}", bits);
        default:
            return fmt::format("{:#010x}", bits);
    }
}

// Compares numbers one after the other, and keeps the worst.
class Comparer {
  public:
    Comparer(std::span<const std::byte> actual, std::span<const std::byte> expected, double tolerance)
        : actual_(actual), expected_(expected), tolerance_(tolerance) {}

    template <typename Place>
    void compare(std::size_t offset, ScalarType type, Place&& place) {
        if (offset + 4 > actual_.size()) return;
        std::uint32_t a = 0, b = 0;
        std::memcpy(&a, actual_.data() + offset, sizeof a);
        std::memcpy(&b, expected_.data() + offset, sizeof b);
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
