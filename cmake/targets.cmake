# What every target of the project shares: warnings, architecture, sanitizers, include root.

add_library(exemplar_options INTERFACE)
target_include_directories(exemplar_options INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
# In a batch (see exemplar_unity), GCC takes the sources for headers, whose unnamed namespaces it warns of.
set(exemplar_warnings -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                      $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi> $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
target_compile_options(exemplar_options INTERFACE "$<BUILD_INTERFACE:${exemplar_warnings}>")
# A product and a sum are two operations, each rounded, so that no batch changes the last bits of results. Eigen fuses
# them itself where the machine can; exemplar_fuse below names the sources where the compiler may.
target_compile_options(exemplar_options INTERFACE "$<BUILD_INTERFACE:-ffp-contract=off>")
# GCC collects its garbage from 512 MB on instead of 128: 7 % less time for a batch, at a quarter more memory.
target_compile_options(exemplar_options INTERFACE "$<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>>")
target_link_libraries(exemplar_options INTERFACE Threads::Threads)

# x86-64-v3 (AVX2, FMA) is ten years old; older machines fall back to the compiler's baseline.
if(EXEMPLAR_ARCH STREQUAL "default")
  set(exemplar_march "")
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND EXISTS /proc/cpuinfo)
    file(STRINGS /proc/cpuinfo exemplar_flags REGEX "^flags.*avx2.*" LIMIT_COUNT 1)
    if(exemplar_flags MATCHES " fma " AND exemplar_flags MATCHES " avx2 " AND exemplar_flags MATCHES " bmi2 ")
      set(exemplar_march x86-64-v3)
    endif()
  endif()
else()
  set(exemplar_march ${EXEMPLAR_ARCH})
endif()
if(exemplar_march)
  target_compile_options(exemplar_options INTERFACE -march=${exemplar_march})
endif()
if(EXEMPLAR_SANITIZE)
  set(exemplar_sanitizers -fsanitize=address,undefined -fno-sanitize-recover=all)
  target_compile_options(exemplar_options INTERFACE
                         "$<BUILD_INTERFACE:${exemplar_sanitizers};-O2;-g1;-fno-omit-frame-pointer>")
  target_link_options(exemplar_options INTERFACE ${exemplar_sanitizers})
endif()
# exemplar_followed: the compiler's options that let libFuzzer follow its input. They are for code that reads files, as their counters
# make loops two to three times as slow. Other compilers than Clang have no libFuzzer.
if(EXEMPLAR_SANITIZE AND CMAKE_CXX_COMPILER_ID MATCHES Clang)
  # Neither Ninja nor ccache sees that compiling reads this file: a copy whose name changes with it tells them.
  set(exemplar_ignored ${PROJECT_SOURCE_DIR}/tests/fuzz/libraries.ignore)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${exemplar_ignored})
  file(SHA1 ${exemplar_ignored} exemplar_ignored_sum)
  set(exemplar_ignored_copy ${PROJECT_BINARY_DIR}/ignored-${exemplar_ignored_sum})
  configure_file(${exemplar_ignored} ${exemplar_ignored_copy} COPYONLY)
  set(exemplar_followed -fsanitize=fuzzer-no-link -fsanitize-coverage-ignorelist=${exemplar_ignored_copy})
endif()

# A batch takes 1 to 2 GB of memory to compile: Ninja compiles no more at a time than this machine holds.
cmake_host_system_information(RESULT exemplar_megabytes QUERY TOTAL_PHYSICAL_MEMORY)
math(EXPR exemplar_compile_jobs "${exemplar_megabytes} / 1500 + 1")
set_property(GLOBAL PROPERTY JOB_POOLS compile=${exemplar_compile_jobs})
set(CMAKE_JOB_POOL_COMPILE compile)

# exemplar_unity(TARGET): compiles the sources of TARGET several at a time. Most of the time to compile a source goes into the
# headers of libraries, which a batch reads once (docs/building.md). EXEMPLAR_UNITY=OFF compiles each source alone;
# EXEMPLAR_UNITY_EXCEPT does so for the libraries that one is changing.
function(exemplar_unity target)
  set(batches ${EXEMPLAR_UNITY})
  string(REPLACE exemplar_ "" name ${target})
  if(name IN_LIST EXEMPLAR_UNITY_EXCEPT)
    set(batches OFF)
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${batches} UNITY_BUILD_BATCH_SIZE ${EXEMPLAR_UNITY_BATCH})
endfunction()

# exemplar_fuse(SOURCE...): lets the compiler fuse products and sums in sources that are little else and run for each frame. They are
# compiled alone, so that no batch decides what is fused.
function(exemplar_fuse)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON COMPILE_OPTIONS -ffp-contract=fast)
endfunction()

# exemplar_library(NAME DIR DEPENDENCY...): the static library exemplar_NAME of all sources in DIR and its folders, but for
# folders that are a library already. Those of host/ and gpu/ are noted for cmake/install.cmake.
function(exemplar_library name dir)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${dir}/*.cpp)
  get_property(taken GLOBAL PROPERTY exemplar_taken_sources)
  list(REMOVE_ITEM sources ${taken})
  set_property(GLOBAL APPEND PROPERTY exemplar_taken_sources ${sources})
  add_library(exemplar_${name} STATIC ${sources})
  exemplar_unity(exemplar_${name})
  target_link_libraries(exemplar_${name} PUBLIC exemplar_options ${ARGN})
  string(REGEX REPLACE "/.*" "" part ${dir})
  set_property(GLOBAL APPEND PROPERTY exemplar_libraries_of_${part} exemplar_${name})
endfunction()

# exemplar_test(NAME LABEL DIR DEPENDENCY...): one GoogleTest program of all sources in tests/DIR; each of its suites is a ctest
# entry with that label (see list_tests.cmake). Suites named Slow* get the label slow instead.
function(exemplar_test name label dir)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${dir}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/(programs|support)/")
  add_executable(test_${name} ${sources})
  exemplar_unity(test_${name})
  # Checks name their file: by its path in the project, so that clones share what a compiler cache holds.
  target_compile_options(test_${name} PRIVATE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
  target_link_libraries(test_${name} PRIVATE exemplar_options ${ARGN} GTest::gmock GTest::gtest GTest::gtest_main)
  set(list ${CMAKE_CURRENT_BINARY_DIR}/test_${name}.cmake)
  add_custom_command(
    TARGET test_${name} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -D program=$<TARGET_FILE:test_${name}> -D name=${name} -D label=${label} -D folder=${PROJECT_SOURCE_DIR}
            -D list=${list} -P ${PROJECT_SOURCE_DIR}/cmake/list_tests.cmake
    BYPRODUCTS ${list} VERBATIM)
  file(CONFIGURE OUTPUT test_${name}_include.cmake @ONLY CONTENT
       "if(EXISTS \"@list@\")\n  include(\"@list@\")\nelse()\n  add_test(test_@name@_NOT_BUILT test_@name@_NOT_BUILT)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_include.cmake)
endfunction()
