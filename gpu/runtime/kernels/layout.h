#pragma once

#include <cstddef>
#include <string_view>
#include <type_traits>
#include <vector>

namespace exemplar {

/// One member of a structure shared by C++ and GLSL, in bytes.
struct FieldLayout {
    std::string_view name;
    std::size_t offset;
    std::size_t bytes;
};

/// Memory layout of a C++ type that kernels read or write. Scalars and vectors have no fields.
struct StructLayout {
    std::string_view name;
    std::size_t bytes = 0;
    std::vector<FieldLayout> fields;
    std::size_t alignment = 1;  ///< C++ pads the structure to a multiple of it
};

/// Returns the layout of T: the one declared with EXEMPLAR_LAYOUT, or only the size for a plain scalar or vector.
template <typename T>
StructLayout layout_of() {
    if constexpr (requires { describe_layout(static_cast<const T*>(nullptr)); })
        return describe_layout(static_cast<const T*>(nullptr));
    else
        return {.name = "a plain value", .bytes = sizeof(T), .fields = {}, .alignment = alignof(T)};
}

}  // namespace exemplar

// EXEMPLAR_LAYOUT(Struct, field, ...) after a shared structure lets Kernel compare it with the shader's declaration.
#define EXEMPLAR_LAYOUT_FIELD(Struct, field) \
    ::exemplar::FieldLayout{#field, offsetof(Struct, field), sizeof(Struct::field)},
#define EXEMPLAR_PARENTHESES ()
#define EXEMPLAR_EXPAND(...) EXEMPLAR_EXPAND2(EXEMPLAR_EXPAND2(EXEMPLAR_EXPAND2(__VA_ARGS__)))
#define EXEMPLAR_EXPAND2(...) EXEMPLAR_EXPAND1(EXEMPLAR_EXPAND1(EXEMPLAR_EXPAND1(__VA_ARGS__)))
#define EXEMPLAR_EXPAND1(...) EXEMPLAR_EXPAND0(EXEMPLAR_EXPAND0(EXEMPLAR_EXPAND0(__VA_ARGS__)))
#define EXEMPLAR_EXPAND0(...) __VA_ARGS__
#define EXEMPLAR_EACH_FIELD(Struct, field, ...) \
    EXEMPLAR_LAYOUT_FIELD(Struct, field) __VA_OPT__(EXEMPLAR_EACH_AGAIN EXEMPLAR_PARENTHESES(Struct, __VA_ARGS__))
#define EXEMPLAR_EACH_AGAIN() EXEMPLAR_EACH_FIELD
#define EXEMPLAR_LAYOUT(Struct, ...)                                                                                \
    static_assert(std::is_standard_layout_v<Struct> && std::is_trivially_copyable_v<Struct>);                       \
    inline ::exemplar::StructLayout describe_layout(const Struct*) {                                                \
        return {                                                                                                    \
            #Struct, sizeof(Struct), {EXEMPLAR_EXPAND(EXEMPLAR_EACH_FIELD(Struct, __VA_ARGS__))}, alignof(Struct)}; \
    }
