# How a variant is compiled, in this tree and outside of it. This file is installed.

# dssbench_variant_module(TARGET NAME name MARCH isa VECTOR_BITS b EXPORTS file [OPTIONS flag...]
#                         SOURCES file...)
#
# A MODULE library NAME.so that exports one symbol, dss_plugin. It is compiled for its own
# instruction set, and reports it.
function(dssbench_variant_module target)
  cmake_parse_arguments(arg "" "NAME;MARCH;VECTOR_BITS;EXPORTS" "OPTIONS;SOURCES" ${ARGN})
  add_library(${target} MODULE ${arg_SOURCES})
  target_compile_options(${target} PRIVATE -march=${arg_MARCH} ${arg_OPTIONS})
  set(isa ${arg_MARCH})
  if(isa STREQUAL native) # find the -march= that the compiler uses for the build host
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -march=native -E -v -x c++ /dev/null
      ERROR_VARIABLE verbose OUTPUT_QUIET)
    if(verbose MATCHES "(-march=|\"?-target-cpu\"? \"?)([a-mo-z][a-z0-9_.-]+|nehalem)")
      set(isa "native: ${CMAKE_MATCH_2}")
    endif()
  endif()
  target_compile_definitions(${target} PRIVATE DSS_VARIANT="${arg_NAME}" DSS_ISA="${isa}"
    DSS_VECTOR_BITS=${arg_VECTOR_BITS})
  # Weak symbols of templates must stay inside. Otherwise link order would decide which
  # instruction set runs.
  target_link_options(${target} PRIVATE -Wl,--version-script=${arg_EXPORTS})
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${arg_NAME}
    LINK_DEPENDS ${arg_EXPORTS})
endfunction()

# dssbench_engine_sources(OUT root)
#
# Sets OUT to the sources of the row engine under `root`: its own, and one for each model and type,
# which are generated. The models are those of kernels/model.hpp.
function(dssbench_engine_sources out root)
  file(GLOB sources CONFIGURE_DEPENDS ${root}/variants/engine/*.cpp)
  file(STRINGS ${root}/kernels/model.hpp models REGEX "^enum class Model {")
  string(REGEX REPLACE ".*{ *(.*[^ ]) *}.*" "\\1" models "${models}")
  string(REGEX REPLACE ", *" ";" models "${models}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${root}/kernels/model.hpp)
  foreach(model IN LISTS models)
    foreach(type double float)
      set(source ${PROJECT_BINARY_DIR}/generated/variants/engine/kernels_${model}_${type}.cpp)
      configure_file(${root}/variants/engine/kernels_of_model.cpp.in ${source} @ONLY)
      list(APPEND sources ${source})
    endforeach()
  endforeach()
  set(${out} ${sources} PARENT_SCOPE)
endfunction()

# dss_march_needs(OUT isa [flag...])
#
# Sets OUT to the CPU features that code uses if it is compiled with -march=isa and with those of
# the flags that start with -m. The features have the names of __builtin_cpu_supports.
function(dss_march_needs out march)
  set(flags ${ARGN})
  list(FILTER flags INCLUDE REGEX "^-m")
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -march=${march} ${flags} -dM -E -x c++ /dev/null
    OUTPUT_VARIABLE macros ERROR_VARIABLE complaint RESULT_VARIABLE result)
  if(result)
    message(FATAL_ERROR "-march=${march} ${flags}: the compiler does not take it\n${complaint}")
  endif()
  set(needs "")
  foreach(feature sse4.2 avx avx2 fma bmi bmi2 avx512f avx512dq avx512bw avx512vl avx512cd
      avx512vbmi avx512ifma avx512vnni)
    string(TOUPPER ${feature} macro)
    string(REPLACE "." "_" macro ${macro})
    if(macros MATCHES "#define __${macro}__ 1")
      list(APPEND needs ${feature})
    endif()
  endforeach()
  set(${out} ${needs} PARENT_SCOPE)
endfunction()
