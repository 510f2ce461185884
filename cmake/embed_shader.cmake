# Writes FOLDER/SYMBOL.cpp and .h: the SPIR-V modules for cards and for CPU drivers as a value of type exemplar::Shader.
# Returns the words of a SPIR-V file as C++ literals.
function(read_words file result)
  file(READ ${file} hex HEX)
  # SPIR-V is little-endian words: swap the bytes of each into one literal, eight literals a line.
  string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${hex}")
  string(REGEX REPLACE "(0x........,0x........,0x........,0x........,0x........,0x........,0x........,0x........,)" "    \\1\n" words "${words}")
  set(${result} "${words}" PARENT_SCOPE)
endfunction()

read_words(${spirv} words)
read_words(${cpu_spirv} cpu_words)
set(cpu_array "")
set(cpu_name ${symbol}_words)
if(NOT words STREQUAL cpu_words)
  set(cpu_name ${symbol}_cpu_words)
  set(cpu_array "static constexpr std::uint32_t ${cpu_name}[] = {
${cpu_words}};
")
endif()
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
${cpu_array}extern const Shader ${symbol}{\"${name}\", ${symbol}_words, ${cpu_name}};
[[maybe_unused]] static const bool ${symbol}_is_noted = note_shader(\"${name}\", ${symbol}_words, ${cpu_name});
}
")
