# 'cmake --install': the programs (component runtime), and what other projects build on (component development): headers,
# static libraries, and the CMake package whose targets are exemplar::host and exemplar::gpu. docs/packaging.md tells more.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(exemplar_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/exemplar)
set(exemplar_include_dir ${CMAKE_INSTALL_INCLUDEDIR}/exemplar)

# The alignment of what Eigen allocates depends on the instruction set, and one side frees what the other allocated: programs
# elsewhere take that of the libraries, however they are compiled themselves.
separate_arguments(exemplar_flags NATIVE_COMMAND "${CMAKE_CXX_FLAGS}")
if(exemplar_march)
  list(APPEND exemplar_flags -march=${exemplar_march})
endif()
execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${exemplar_flags} -dM -E -x c++ /dev/null
                OUTPUT_VARIABLE exemplar_macros COMMAND_ERROR_IS_FATAL ANY)
if(exemplar_macros MATCHES "__AVX512F__")
  set(exemplar_alignment 64)
elseif(exemplar_macros MATCHES "__AVX__")
  set(exemplar_alignment 32)
else()
  set(exemplar_alignment 16)
endif()
# -march (see targets.cmake) is theirs too: the libraries ask for that processor anyway, and with it inline functions are the
# same on both sides.
target_include_directories(exemplar_options INTERFACE $<INSTALL_INTERFACE:${exemplar_include_dir}>)
target_compile_features(exemplar_options INTERFACE $<INSTALL_INTERFACE:cxx_std_20>)
target_compile_definitions(exemplar_options INTERFACE $<INSTALL_INTERFACE:EIGEN_MAX_ALIGN_BYTES=${exemplar_alignment}>)

# exemplar_install_part(PART LIBRARY...): the libraries as exemplar::NAME, all of them as exemplar::PART, and their headers.
function(exemplar_install_part part)
  add_library(exemplar_${part} INTERFACE)
  target_link_libraries(exemplar_${part} INTERFACE ${ARGN})
  foreach(target ${ARGN} exemplar_${part})
    string(REGEX REPLACE "^exemplar_" "" name ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  endforeach()
  install(TARGETS ${ARGN} exemplar_${part} EXPORT exemplar_${part} COMPONENT development)
  install(EXPORT exemplar_${part} NAMESPACE exemplar:: FILE exemplar-${part}.cmake DESTINATION ${exemplar_package_dir} COMPONENT development)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${part} DESTINATION ${exemplar_include_dir} COMPONENT development
          FILES_MATCHING PATTERN "*.h" PATTERN functions.h EXCLUDE PATTERN window EXCLUDE PATTERN report_page EXCLUDE)
endfunction()

get_property(exemplar_host_libraries GLOBAL PROPERTY exemplar_libraries_of_host)
exemplar_install_part(host exemplar_options ${exemplar_host_libraries})
if(EXEMPLAR_GPU)
  # gpu/window stays out: only the viewer needs it, and everybody would need Dear ImGui.
  get_property(exemplar_gpu_libraries GLOBAL PROPERTY exemplar_libraries_of_gpu)
  list(REMOVE_ITEM exemplar_gpu_libraries exemplar_gpu_window)
  exemplar_install_part(gpu ${exemplar_gpu_libraries})
  target_link_libraries(exemplar_gpu INTERFACE exemplar_host)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/shaders/shared DESTINATION ${exemplar_include_dir}/shaders COMPONENT development
          FILES_MATCHING PATTERN "*.h" PATTERN window.h EXCLUDE PATTERN test_kernels.h EXCLUDE)
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/exemplar-config.cmake.in ${PROJECT_BINARY_DIR}/exemplar-config.cmake
                              INSTALL_DESTINATION ${exemplar_package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/exemplar-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/exemplar-config.cmake ${PROJECT_BINARY_DIR}/exemplar-config-version.cmake
        DESTINATION ${exemplar_package_dir} COMPONENT development)

# The license, under the name that Debian gives it.
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR}-dev RENAME copyright COMPONENT development)
if(EXEMPLAR_GPU)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT runtime)
  find_program(EXEMPLAR_GZIP gzip REQUIRED)
  set(exemplar_pages ${PROJECT_BINARY_DIR}/help)
  add_custom_command(
    OUTPUT ${exemplar_pages}/made
    COMMAND ${CMAKE_COMMAND} -D EXEMPLAR=$<TARGET_FILE:exemplar> -D VIEWER=$<TARGET_FILE:exemplar-viewer>
            -D FOLDER=${exemplar_pages} -D GZIP=${EXEMPLAR_GZIP} -P ${PROJECT_SOURCE_DIR}/cmake/help_pages.cmake
    DEPENDS exemplar exemplar-viewer ${PROJECT_SOURCE_DIR}/cmake/help_pages.cmake
    COMMENT "Writing man pages and completion"
    VERBATIM)
  add_custom_target(help_pages ALL DEPENDS ${exemplar_pages}/made)
  install(TARGETS exemplar exemplar-viewer COMPONENT runtime)
  if(TARGET exemplar-import)
    install(TARGETS exemplar-import COMPONENT runtime)
  endif()
  install(DIRECTORY ${exemplar_pages}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT runtime)
  install(DIRECTORY ${exemplar_pages}/bash/ DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT runtime)
  install(DIRECTORY ${exemplar_pages}/zsh/ DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT runtime)
  install(DIRECTORY ${exemplar_pages}/fish/ DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT runtime)
  install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
  include(cmake/debian.cmake)
endif()
