#pragma once

#include <cstddef>
#include <vector>

#if defined(__SANITIZE_ADDRESS__)  // GCC
#define EXEMPLAR_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)  // Clang
#define EXEMPLAR_SANITIZED
#endif
#endif

namespace exemplar::test_support {

#ifdef EXEMPLAR_SANITIZED
inline constexpr bool k_sanitized = true;
#else
inline constexpr bool k_sanitized = false;
#endif

/// Returns all cases of a test, or every fourth of them with sanitizers, which make each ten times as slow: they look
/// at what the code does, which is the same for all, not at what comes out.
template <typename Case>
std::vector<Case> fewer_if_sanitized(const std::vector<Case>& cases) {
    if (!k_sanitized) return cases;
    std::vector<Case> fewer;
    for (std::size_t i = 0; i < cases.size(); i += 4) fewer.push_back(cases[i]);
    return fewer;
}

}  // namespace exemplar::test_support
