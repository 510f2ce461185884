#pragma once

// Whether AddressSanitizer watches this program: EXEMPLAR_SANITIZED for the preprocessor, k_sanitized elsewhere.

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

}  // namespace exemplar::test_support
