# Man pages and completion in FOLDER, by the programs EXEMPLAR and VIEWER themselves: what they say is what is defined in them.
file(REMOVE_RECURSE ${FOLDER})
foreach(program ${EXEMPLAR} ${VIEWER})
  # Defaults below the home folder are shown as everybody's, not as those of who builds.
  execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=XDG_CACHE_HOME HOME=~ ${program} --help-pages ${FOLDER}
                  COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(GLOB pages ${FOLDER}/man1/*.1)
execute_process(COMMAND ${GZIP} -9n ${pages} COMMAND_ERROR_IS_FATAL ANY)
file(TOUCH ${FOLDER}/made)
