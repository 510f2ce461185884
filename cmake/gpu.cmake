# Everything that speaks Vulkan: the libraries of gpu/ and the shaders they embed.

find_package(Vulkan REQUIRED)
pkg_check_modules(SPIRV_CROSS REQUIRED IMPORTED_TARGET spirv-cross-c-shared)
find_program(EXEMPLAR_GLSLANG glslangValidator REQUIRED)
find_program(EXEMPLAR_SPIRV_VAL spirv-val REQUIRED)

# exemplar_shader_module(SHADER SPIRV TITLE DEFINITION...): compiles one shader and validates it.
function(exemplar_shader_module shader spirv title)
  add_custom_command(
    OUTPUT ${spirv}
    COMMAND ${EXEMPLAR_GLSLANG} --quiet --target-env vulkan1.2 ${ARGN} -I${PROJECT_SOURCE_DIR} --depfile ${spirv}.d -o ${spirv}
            ${shader}
    COMMAND ${EXEMPLAR_SPIRV_VAL} --target-env vulkan1.2 ${spirv}
    DEPENDS ${shader}
    DEPFILE ${spirv}.d
    COMMENT "Compiling shader ${title}"
    VERBATIM)
endfunction()

# exemplar_shaders(TARGET FOLDER): compiles every shader of shaders/FOLDER for Vulkan 1.2 (with 1.3, local sizes from
# specialization constants need maintenance4), validates it and embeds it in TARGET. shaders/learn/stumps.comp becomes
# the value exemplar::shaders::learn_stumps_comp, declared in "embedded/learn_stumps_comp.h". Each is compiled for cards
# and, with EXEMPLAR_CPU defined, for CPU drivers; if both are equal, one is embedded.
function(exemplar_shaders target folder)
  set(root ${PROJECT_SOURCE_DIR}/shaders)
  set(embedded ${PROJECT_BINARY_DIR}/shaders/embedded)
  file(GLOB shaders CONFIGURE_DEPENDS ${root}/${folder}/*.comp ${root}/${folder}/*.vert ${root}/${folder}/*.frag)
  file(MAKE_DIRECTORY ${embedded})
  foreach(shader ${shaders})
    cmake_path(RELATIVE_PATH shader BASE_DIRECTORY ${root} OUTPUT_VARIABLE name)
    string(MAKE_C_IDENTIFIER ${name} symbol)
    set(spirv ${PROJECT_BINARY_DIR}/shaders/${symbol}.spv)
    set(cpu_spirv ${PROJECT_BINARY_DIR}/shaders/${symbol}_cpu.spv)
    exemplar_shader_module(${shader} ${spirv} "${name}")
    exemplar_shader_module(${shader} ${cpu_spirv} "${name} for CPU drivers" -DEXEMPLAR_CPU)
    add_custom_command(
      OUTPUT ${embedded}/${symbol}.cpp ${embedded}/${symbol}.h
      COMMAND ${CMAKE_COMMAND} -D spirv=${spirv} -D cpu_spirv=${cpu_spirv} -D name=${name} -D symbol=${symbol}
              -D folder=${embedded} -P ${PROJECT_SOURCE_DIR}/cmake/embed_shader.cmake
      DEPENDS ${spirv} ${cpu_spirv} ${PROJECT_SOURCE_DIR}/cmake/embed_shader.cmake
      VERBATIM)
    target_sources(${target} PRIVATE ${embedded}/${symbol}.cpp ${embedded}/${symbol}.h)
  endforeach()
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/shaders>)
endfunction()

exemplar_library(runtime gpu/runtime exemplar_core Vulkan::Headers $<BUILD_INTERFACE:PkgConfig::SPIRV_CROSS>
                                     $<INSTALL_INTERFACE:$<LINK_ONLY:PkgConfig::SPIRV_CROSS>> PRIVATE PkgConfig::XXHASH ${CMAKE_DL_LIBS})
exemplar_shaders(exemplar_runtime runtime)

exemplar_library(gpu_learn gpu/learn exemplar_runtime exemplar_learn)
exemplar_shaders(exemplar_gpu_learn learn)

exemplar_library(gpu_labeling gpu/labeling exemplar_runtime exemplar_labeling)
exemplar_shaders(exemplar_gpu_labeling labeling)

exemplar_library(gpu_imaging gpu/imaging exemplar_runtime exemplar_imaging)
exemplar_shaders(exemplar_gpu_imaging imaging)

exemplar_library(gpu_curvature gpu/curvature exemplar_runtime exemplar_animation exemplar_curvature)
exemplar_shaders(exemplar_gpu_curvature curvature)

# Windows are of the caller: nothing here knows GLFW. libimgui's Vulkan backend stays out: it would link the loader.
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
exemplar_library(gpu_window gpu/window exemplar_gpu_imaging exemplar_runtime exemplar_imaging PkgConfig::IMGUI)
exemplar_shaders(exemplar_gpu_window window)

exemplar_library(gpu_lines gpu/lines exemplar_gpu_imaging exemplar_gpu_curvature exemplar_lines)
exemplar_shaders(exemplar_gpu_lines lines)

exemplar_library(gpu_hatching gpu/hatching exemplar_gpu_imaging exemplar_gpu_learn exemplar_runtime exemplar_hatching)
exemplar_shaders(exemplar_gpu_hatching hatching)
