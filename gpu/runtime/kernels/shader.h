#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace exemplar {

/// A shader's SPIR-V modules, embedded at build time; `name` is its path under shaders/, e.g. "learn/stumps.comp".
struct Shader {
    std::string_view name;
    std::span<const std::uint32_t> words;        ///< for cards
    std::span<const std::uint32_t> cpu_words{};  ///< for CPU drivers (EXEMPLAR_CPU is defined); often the same
};

}  // namespace exemplar
