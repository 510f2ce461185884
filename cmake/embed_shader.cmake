# Writes FOLDER/SYMBOL.cpp and .h: the SPIR-V module as a value of type exemplar::Shader.
file(READ ${spirv} hex HEX)
# SPIR-V is little-endian words: swap the bytes of each into one literal, eight literals a line.
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${hex}")
string(REGEX REPLACE "(0x........,0x........,0x........,0x........,0x........,0x........,0x........,0x........,)" "    \\1\n" words "${words}")
file(WRITE ${folder}/${symbol}.h "#pragma once

#include \"gpu/runtime/kernels/shader.h\"

namespace exemplar::shaders {
extern const Shader ${symbol};
}
")
file(WRITE ${folder}/${symbol}.cpp "#include \"embedded/${symbol}.h\"

#include \"gpu/runtime/device/tuning.h\"

namespace exemplar::shaders {
static constexpr std::uint32_t ${symbol}_words[] = {
${words}};
extern const Shader ${symbol}{\"${name}\", ${symbol}_words};
[[maybe_unused]] static const bool ${symbol}_is_noted = note_shader(\"${name}\", ${symbol}_words);
}
")
