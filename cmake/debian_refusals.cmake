# Read by cpack before it packs.
if(CPACK_GENERATOR STREQUAL "DEB" AND CPACK_EXEMPLAR_MARCH)
  message(FATAL_ERROR "this build runs on ${CPACK_EXEMPLAR_MARCH} alone; configure one with -DEXEMPLAR_ARCH= or call apps/package.sh")
endif()
