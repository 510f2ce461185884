# 'cpack -G DEB' (apps/package.sh calls it): the packages exemplar (component runtime) and exemplar-dev (development).

set(CPACK_PACKAGE_NAME exemplar)
set(CPACK_PACKAGE_VENDOR "The Exemplar authors")
set(CPACK_PACKAGE_CONTACT "The Exemplar authors <maintainers@exemplar.invalid>" CACHE STRING "Maintainer of packages")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "geometry processing learned from examples")
set(exemplar_about "Labels the parts of 3D meshes after being shown a few labeled ones, learns how
the curvature of an animated surface follows from its pose and draws it in
lines, and learns to hatch in pen and ink from one drawing.
.
What was learned runs on the GPU through Vulkan compute, or on the CPU by
Mesa's software driver.
.")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME exemplar)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION graphics)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "${exemplar_about}
This package has the programs exemplar and exemplar-viewer.")
# Libraries are found by dpkg-shlibdeps, but for the Vulkan loader, which is opened while the programs run.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS libvulkan1)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "mesa-vulkan-drivers, fonts-dejavu-core")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "ffmpeg")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME exemplar-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${exemplar_about}
This package has the headers, static libraries and CMake package.")
# What exemplar-config.cmake looks for.
string(JOIN ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
       libeigen3-dev libtbb-dev libfmt-dev nlohmann-json3-dev libpng-dev libturbojpeg0-dev libexpat1-dev libembree-dev libtinyobjloader-dev libtinygltf-dev
       libdraco-dev libmeshoptimizer-dev libnlopt-dev libxxhash-dev libsqlite3-dev pkg-config libvulkan-dev libspirv-cross-c-shared-dev)

# Debian wants a changelog of the packages in a form of its own; it points to that of the project.
string(TIMESTAMP exemplar_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(CONFIGURE OUTPUT debian/changelog @ONLY CONTENT
"exemplar (@PROJECT_VERSION@) unstable; urgency=medium

  * What is new stands in /usr/share/doc/exemplar/CHANGELOG.md.

 -- @CPACK_PACKAGE_CONTACT@  @exemplar_date@
")
execute_process(COMMAND ${EXEMPLAR_GZIP} -9nc ${PROJECT_BINARY_DIR}/debian/changelog
                OUTPUT_FILE ${PROJECT_BINARY_DIR}/debian/changelog.gz COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${PROJECT_BINARY_DIR}/debian/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
install(FILES ${PROJECT_BINARY_DIR}/debian/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR}-dev COMPONENT development)

# A package runs on every processor of its architecture; -march is for the machine that it is set on.
set(CPACK_EXEMPLAR_MARCH "${exemplar_march}")
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/debian_refusals.cmake)
include(CPack)
