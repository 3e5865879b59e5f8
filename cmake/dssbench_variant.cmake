# How a variant is compiled, in this tree and outside of it. This file is installed.
# dss_isa_folder, set by whoever includes it, is the folder variants/isa.

# The processor that is compiled for, as variants/isa names it.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set(dss_architecture x86)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  set(dss_architecture aarch64)
else()
  message(FATAL_ERROR
    "variants/isa has no folder for ${CMAKE_SYSTEM_PROCESSOR}; it has x86 and aarch64")
endif()

# dss_isa(OUT isa key)
#
# Sets OUT to the value of a key of variants/isa/ISA/isa.json for this processor. It is empty if the
# instruction set belongs to another processor.
function(dss_isa out isa key)
  set(file ${dss_isa_folder}/${isa}/isa.json)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} text)
  string(JSON processor ERROR_VARIABLE is_of_another GET "${text}" ${dss_architecture})
  set(value "")
  if(NOT is_of_another)
    string(JSON value GET "${processor}" ${key})
  endif()
  set(${out} "${value}" PARENT_SCOPE)
endfunction()

# dssbench_variant_module(TARGET NAME name MARCH march ISA isa EXPORTS file [OPTIONS flag...]
#                         SOURCES file...)
#
# A MODULE library NAME.so that exports one symbol, dss_plugin. It is compiled for its own
# instruction set, and reports it.
function(dssbench_variant_module target)
  cmake_parse_arguments(arg "" "NAME;MARCH;ISA;EXPORTS" "OPTIONS;SOURCES" ${ARGN})
  add_library(${target} MODULE ${arg_SOURCES})
  target_compile_options(${target} PRIVATE -march=${arg_MARCH} ${arg_OPTIONS})
  set(march ${arg_MARCH})
  if(march STREQUAL native) # find the -march= that the compiler uses for the build host
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -march=native -E -v -x c++ /dev/null
      ERROR_VARIABLE verbose OUTPUT_QUIET)
    if(verbose MATCHES "(-march=|\"?-target-cpu\"? \"?)([a-mo-z][a-z0-9_.-]+|nehalem)")
      set(march "native: ${CMAKE_MATCH_2}")
    endif()
  endif()
  target_compile_definitions(${target} PRIVATE DSS_VARIANT="${arg_NAME}" DSS_ISA="${march}")
  dss_use_packs(${target} ${arg_ISA})
  # Weak symbols of templates must stay inside. Otherwise link order would decide which
  # instruction set runs.
  target_link_options(${target} PRIVATE -Wl,--version-script=${arg_EXPORTS})
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${arg_NAME}
    LINK_DEPENDS ${arg_EXPORTS})
endfunction()

# dssbench_engine_sources(OUT root isa)
#
# Sets OUT to the sources of the row engine under `root`: its own, and one for each model, type and
# kind of lanes (LaneKind), which are generated. The models are those of kernels/model.hpp. Without
# packs there are no lanes for the members of an ensemble.
function(dssbench_engine_sources out root isa)
  set(kinds neighbours filled)
  if(NOT isa STREQUAL scalar)
    list(APPEND kinds members)
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${root}/variants/engine/*.cpp)
  file(STRINGS ${root}/kernels/model.hpp models REGEX "^enum class Model {")
  string(REGEX REPLACE ".*{ *(.*[^ ]) *}.*" "\\1" models "${models}")
  string(REGEX REPLACE ", *" ";" models "${models}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${root}/kernels/model.hpp)
  foreach(model IN LISTS models)
    foreach(type double float)
      foreach(kind IN LISTS kinds)
        if(kind STREQUAL filled AND NOT model MATCHES "^(planar|spatial)$") # has_filled_rows
          continue()
        endif()
        set(source
          ${PROJECT_BINARY_DIR}/generated/variants/engine/${kind}_${model}_${type}.cpp)
        configure_file(${root}/variants/engine/kernels_of_model.cpp.in ${source} @ONLY)
        list(APPEND sources ${source})
      endforeach()
    endforeach()
  endforeach()
  set(${out} ${sources} PARENT_SCOPE)
endfunction()

# dss_use_packs(TARGET isa): kernels/simd/simd.hpp takes the packs of this instruction set, and
# knows how many registers it has.
function(dss_use_packs target isa)
  if(NOT EXISTS ${dss_isa_folder}/${isa}/packs.hpp)
    message(FATAL_ERROR "${dss_isa_folder} has no instruction set ${isa}")
  endif()
  dss_isa(registers ${isa} registers)
  target_compile_definitions(${target} PRIVATE DSS_ISA_PACKS="variants/isa/${isa}/packs.hpp"
    DSS_ISA_REGISTERS=${registers})
endfunction()

# dss_march_needs(OUT march [flag...])
#
# Sets OUT to the CPU features that code uses if it is compiled with -march=MARCH and with those of
# the flags that start with -m: those whose macro the compiler then defines.
function(dss_march_needs out march)
  set(flags ${ARGN})
  list(FILTER flags INCLUDE REGEX "^-m")
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -march=${march} ${flags} -dM -E -x c++ /dev/null
    OUTPUT_VARIABLE macros ERROR_VARIABLE complaint RESULT_VARIABLE result)
  if(result)
    message(FATAL_ERROR "-march=${march} ${flags}: the compiler does not take it\n${complaint}")
  endif()
  set(features ${dss_isa_folder}/${dss_architecture}/cpu_features.hpp)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${features})
  file(READ ${features} text)
  string(REGEX MATCHALL "X\\(\"[a-z0-9.]+\", __[A-Z0-9_]+" entries "${text}")
  set(needs "")
  foreach(entry IN LISTS entries)
    string(REGEX MATCH "\"(.+)\", (.+)" found "${entry}")
    set(feature ${CMAKE_MATCH_1})
    if(macros MATCHES "#define ${CMAKE_MATCH_2} 1")
      list(APPEND needs ${feature})
    endif()
  endforeach()
  set(${out} ${needs} PARENT_SCOPE)
endfunction()
