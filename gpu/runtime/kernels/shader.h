#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace exemplar {

/// A SPIR-V module embedded at build time; `name` is its path under shaders/, e.g. "learn/stumps.comp".
struct Shader {
    std::string_view name;
    std::span<const std::uint32_t> words;
};

}  // namespace exemplar
