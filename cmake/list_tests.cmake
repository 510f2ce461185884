cmake_minimum_required(VERSION 3.25)

# Lists the test suites of a GoogleTest program for CTest, after the program was linked: one entry a suite, as starting a program
# (with a Vulkan device, compiled kernels, fixtures) takes longer than most of its tests.
#   cmake -D program=FILE -D name=NAME -D label=LABEL -D folder=WORKING_FOLDER -D list=OUTPUT -P list_tests.cmake
# Suites named Slow* get the label slow.
execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE tests COMMAND_ERROR_IS_FATAL ANY TIMEOUT 60)
string(REGEX MATCHALL "(^|\n)[^ \n]+\\." suites "${tests}")
set(seen "")
set(script "")
foreach(suite ${suites})
  string(REGEX REPLACE "^\n|\\.$" "" suite "${suite}")
  # Parameters make several suites of one: PREFIX/SUITE for values, SUITE/NUMBER for types.
  string(REGEX REPLACE "^[A-Z][A-Za-z0-9]*/([A-Z][A-Za-z0-9]*)$" "\\1" suite "${suite}")
  string(REGEX REPLACE "/[0-9]+$" "" suite "${suite}")
  if(suite IN_LIST seen)
    continue()
  endif()
  list(APPEND seen ${suite})
  set(label_of_suite ${label})
  if(suite MATCHES "^Slow")
    set(label_of_suite slow)
  endif()
  string(APPEND script "add_test([==[${name}.${suite}]==] [==[${program}]==] [==[--gtest_filter=${suite}.*:*/${suite}.*:${suite}/*]==] --gtest_brief=1)
set_tests_properties([==[${name}.${suite}]==] PROPERTIES LABELS ${label_of_suite} TIMEOUT 1800 WORKING_DIRECTORY [==[${folder}]==])
")
endforeach()
if(NOT seen)
  message(FATAL_ERROR "${program} lists no tests")
endif()
file(WRITE ${list} "${script}")
