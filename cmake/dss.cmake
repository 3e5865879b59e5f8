# Build rules that every folder uses: common options, variants, tests.

set(dss_isa_folder ${PROJECT_SOURCE_DIR}/variants/isa)
include(${CMAKE_CURRENT_LIST_DIR}/dssbench_variant.cmake)

add_library(dss_options INTERFACE)
target_include_directories(dss_options INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
  $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>)
target_compile_features(dss_options INTERFACE cxx_std_20)
# -ffp-contract=off: a fused multiply-add is where the source says so, and nowhere else (DESIGN.md
# section 5).
# ggc: the compiler collects garbage less often, and so compiles 5 to 10 % faster.
set(less_collection "SHELL:--param=ggc-min-expand=200 --param=ggc-min-heapsize=819200")
target_compile_options(dss_options INTERFACE -ffp-contract=off
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:${less_collection}>>
  $<BUILD_INTERFACE:-Wall> $<BUILD_INTERFACE:-Wextra> $<BUILD_INTERFACE:-Wpedantic>
  $<BUILD_INTERFACE:-Wshadow> $<BUILD_INTERFACE:$<$<BOOL:${DSS_WERROR}>:-Werror>>)
if(DSS_SANITIZE)
  target_compile_options(dss_options INTERFACE -fsanitize=${DSS_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(dss_options INTERFACE -fsanitize=${DSS_SANITIZE})
  target_compile_definitions(dss_options INTERFACE DSS_SANITIZED)
endif()

# dss_unity(TARGET n)
#
# Compiles the target's sources n at a time, because headers take most of the time. DSS_UNITY=OFF
# compiles each source by itself. Sources with options of their own stay apart. The engine needs
# DSS_UNITY_ENGINE for it: as one file it was 2 % slower with AVX2.
function(dss_unity target size)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${DSS_UNITY} UNITY_BUILD_MODE BATCH
    UNITY_BUILD_BATCH_SIZE ${size})
endfunction()

# dss_add_variant(NAME ORDER n [ISA isa] [MARCH march] [BY_NAME] [NEEDS feature...]
#                 [OPTIONS flag...] [SOURCES file...])
#
# Adds a variant: one MODULE library that exports one symbol and is compiled for its own instruction
# set, and one entry of the registry that the loader reads. If the instruction set belongs to
# another processor, the variant is listed as missing.
#   ORDER    place among the variants, slowest first; `--variant auto` takes the last one that this
#            CPU can run
#   ISA      folder of variants/isa whose packs are used (default: scalar); without SOURCES the
#            module consists of the row engine (variants/engine)
#   MARCH    as in the compiler's -march=; without it, that of ISA
#   BY_NAME  auto never chooses it, because it computes by other variants, on devices or by other
#            methods; the module itself tells whether it can run
#   NEEDS    CPU features that are checked before the module is opened; those that MARCH and -m...
#            in OPTIONS let the compiler use are added
function(dss_add_variant name)
  cmake_parse_arguments(arg "BY_NAME" "ORDER;ISA;MARCH" "NEEDS;OPTIONS;SOURCES" ${ARGN})
  if(NOT arg_ISA)
    set(arg_ISA scalar)
  endif()
  if(NOT arg_MARCH)
    dss_isa(arg_MARCH ${arg_ISA} march)
  endif()
  if(NOT arg_MARCH)
    dss_add_missing_variant(${name} ORDER ${arg_ORDER}
      REASON "not for ${dss_architecture} processors")
    return()
  endif()
  if(name IN_LIST DSS_LEFT_OUT)
    dss_add_missing_variant(${name} ORDER ${arg_ORDER} REASON "left out of this build")
    return()
  endif()
  set(is_engine FALSE)
  if(NOT arg_SOURCES)
    set(is_engine TRUE)
    dssbench_engine_sources(arg_SOURCES ${PROJECT_SOURCE_DIR} ${arg_ISA})
  endif()
  string(REPLACE "-" "_" target dss_variant_${name})
  dssbench_variant_module(${target} NAME ${name} MARCH ${arg_MARCH} ISA ${arg_ISA}
    EXPORTS ${PROJECT_SOURCE_DIR}/variants/exports.map OPTIONS ${arg_OPTIONS}
    SOURCES ${arg_SOURCES})
  if(is_engine AND DSS_UNITY_ENGINE)
    dss_unity(${target} 10)
    # It instantiates members of a class that packed_rows.cpp instantiates as a whole.
    set_source_files_properties(${PROJECT_SOURCE_DIR}/variants/engine/applied_rows.cpp
      PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  if(is_engine) # all its files include these
    target_precompile_headers(${target} PRIVATE
      ${PROJECT_SOURCE_DIR}/kernels/stage_row/stage_row.hpp
      ${PROJECT_SOURCE_DIR}/variants/api/api.hpp)
  endif()
  target_link_libraries(${target} PRIVATE dss_options dss_solver OpenMP::OpenMP_CXX)
  target_compile_definitions(${target} PRIVATE
    $<$<BOOL:${DSS_FEWER_KERNELS}>:DSS_FEWER_KERNELS>
    $<$<IN_LIST:${name},${DSS_PLAIN_ROWS}>:DSS_PLAIN_ROWS>)
  # A quarter less time to compile than with -O3.
  target_compile_options(${target} PRIVATE $<$<IN_LIST:${name},${DSS_PLAIN_ROWS}>:-O1>)
  set_target_properties(${target} PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/variants)
  install(TARGETS ${target} LIBRARY DESTINATION lib/dssbench/variants)
  set_property(GLOBAL APPEND PROPERTY DSS_VARIANT_TARGETS ${target})
  dss_march_needs(needs ${arg_MARCH} ${arg_OPTIONS})
  list(APPEND needs ${arg_NEEDS})
  list(REMOVE_DUPLICATES needs)
  dss_register(${name} ORDER ${arg_ORDER} MARCH ${arg_MARCH} NEEDS ${needs}
    BY_NAME ${arg_BY_NAME})
endfunction()

# dss_register(NAME ORDER n MARCH march BY_NAME is_by_name NEEDS feature...)
#
# Adds an entry of the registry for a variant of this build.
function(dss_register name)
  cmake_parse_arguments(arg "" "ORDER;MARCH;BY_NAME" "NEEDS" ${ARGN})
  string(JOIN "," needs ${arg_NEEDS})
  string(TOLOWER ${arg_BY_NAME} is_by_name)
  set_property(GLOBAL APPEND PROPERTY DSS_VARIANTS
    "${arg_ORDER}|{\"${name}\", \"${arg_MARCH}\", \"${needs}\", \"\", ${is_by_name}},")
endfunction()

# dss_add_missing_variant(NAME ORDER n REASON text)
#
# A variant that this build lacks. It is listed, and skipped with the reason.
function(dss_add_missing_variant name)
  cmake_parse_arguments(arg "" "ORDER;REASON" "" ${ARGN})
  message(STATUS "variant ${name}: ${arg_REASON}")
  set_property(GLOBAL APPEND PROPERTY DSS_VARIANTS
    "${arg_ORDER}|{\"${name}\", \"\", \"\", \"${arg_REASON}\", true},")
endfunction()

# Writes the sorted entries of a global property, each `number|text`, to generated/variants/NAME.
function(dss_write_table name property)
  get_property(entries GLOBAL PROPERTY ${property})
  list(SORT entries COMPARE NATURAL)
  list(TRANSFORM entries REPLACE "^[0-9]+\\|" "")
  string(JOIN "\n" text "// Generated by cmake/dss.cmake." ${entries})
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/variants/${name} CONTENT "${text}\n" @ONLY)
endfunction()

# Writes registry.inc from all calls of dss_add_variant.
function(dss_write_registry)
  dss_write_table(registry.inc DSS_VARIANTS)
endfunction()

# Writes instruction_sets.inc from the folders of variants/isa, for this processor.
function(dss_write_instruction_sets)
  file(GLOB files CONFIGURE_DEPENDS ${dss_isa_folder}/*/isa.json)
  foreach(file IN LISTS files)
    cmake_path(GET file PARENT_PATH folder)
    cmake_path(GET folder FILENAME isa)
    dss_isa(march ${isa} march)
    if(NOT march)
      continue()
    endif()
    foreach(key register registers pack_bytes peak_f64 peak_f32 stream_suffix)
      dss_isa(${key} ${isa} ${key})
    endforeach()
    dss_march_needs(needs ${march})
    string(JOIN "," needs ${needs})
    string(CONCAT row "{\"${isa}\", \"${march}\", \"${needs}\", \"${register}\", ${registers}, "
      "${pack_bytes}, \"${peak_f64}\", \"${peak_f32}\", \"${stream_suffix}\"},")
    set_property(GLOBAL APPEND PROPERTY DSS_INSTRUCTION_SETS "${pack_bytes}|${row}")
  endforeach()
  dss_write_table(instruction_sets.inc DSS_INSTRUCTION_SETS)
endfunction()

# The environment of tests. It has only one variable, because gtest_discover_tests splits lists. The
# build tree keeps the compiled OpenCL programs, ours and PoCL's, for all tests together. Under the
# thread sanitizer (which is built without OpenCL) LLVM's OpenMP runtime loads Archer, which tells
# the sanitizer of barriers. Without Archer every barrier would count as a race.
set(dss_test_environment "XDG_CACHE_HOME=${PROJECT_BINARY_DIR}/cache")
if(DSS_SANITIZE MATCHES "thread")
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-resource-dir
    OUTPUT_VARIABLE clang_resources OUTPUT_STRIP_TRAILING_WHITESPACE)
  find_library(DSS_ARCHER archer HINTS ${clang_resources}/../.. REQUIRED)
  set(dss_test_environment "OMP_TOOL_LIBRARIES=${DSS_ARCHER}")
endif()

set(dss_test_options $<$<CONFIG:Release>:-O1>) # of the tests; the code under test has its own

# dss_test(NAME [TEAMS filter] [LONG filter] source...)
#
# A GoogleTest executable over the solver and the variants. ctest runs each of its tests by itself,
# with the label of its folder.
#   TEAMS  names tests, as --gtest_filter does, whose threads wait for each other; they reserve two
#          processors, since beside other tests they would take ten times as long
#   LONG   names tests that CI leaves to .ci/long: their label ends with -long
function(dss_test name)
  cmake_parse_arguments(arg "" "TEAMS;LONG" "" ${ARGN})
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  dss_unity(${name} 7)
  target_compile_options(${name} PRIVATE ${dss_test_options})
  target_compile_definitions(${name} PRIVATE $<$<BOOL:${DSS_FEWER_KERNELS}>:DSS_FEWER_KERNELS>)
  if(NOT DSS_WHOLE_INCLUDES)
    target_precompile_headers(${name} REUSE_FROM dss_test_headers)
  endif()
  target_link_libraries(${name} PRIVATE dss_options dss_solver dss_variants GTest::gtest_main)
  add_dependencies(${name} dss_all_variants)
  get_filename_component(kind ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  set(environment ENVIRONMENT "${dss_test_environment}")
  # On a busy machine, listing the tests of a fresh executable has taken over 5 s, the default.
  set(discovery DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 120)
  set(processors 1)
  if(arg_TEAMS)
    set(processors 2)
    gtest_discover_tests(${name} TEST_FILTER "${arg_TEAMS}-${arg_LONG}" TEST_LIST ${name}_teams
      PROPERTIES LABELS ${kind} PROCESSORS ${processors} ${environment} ${discovery})
  endif()
  if(arg_LONG)
    gtest_discover_tests(${name} TEST_FILTER "${arg_LONG}" TEST_LIST ${name}_long
      PROPERTIES LABELS ${kind}-long PROCESSORS ${processors} ${environment} ${discovery})
  endif()
  gtest_discover_tests(${name} TEST_FILTER "-${arg_TEAMS}:${arg_LONG}"
    PROPERTIES LABELS ${kind} ${environment} ${discovery})
endfunction()

# dss_embed(TARGET FILES path...)
#
# Puts the text of files into a target. Paths start at the root of the source tree;
# dss::embedded(path) gives the text (variants/opencl/embedded.hpp). Call it once for each target.
function(dss_embed target)
  cmake_parse_arguments(arg "" "" "FILES" ${ARGN})
  set(definitions "")
  set(cases "")
  foreach(path IN LISTS arg_FILES)
    set(file ${PROJECT_SOURCE_DIR}/${path})
    if(NOT EXISTS ${file})
      message(FATAL_ERROR "dss_embed(${target}): there is no ${file}")
    endif()
    string(MAKE_C_IDENTIFIER "dss_embedded_${path}" symbol)
    string(APPEND definitions
      "asm(\".pushsection .rodata\\n.global ${symbol}\\n.hidden ${symbol}\\n${symbol}:\\n\"\n"
      "    \".incbin \\\"${file}\\\"\\n\"\n"
      "    \".global ${symbol}_end\\n.hidden ${symbol}_end\\n${symbol}_end:\\n.popsection\");\n"
      "extern \"C\" [[gnu::visibility(\"hidden\")]] const char ${symbol}[], ${symbol}_end[];\n")
    string(APPEND cases
      "  if (path == \"${path}\") return {${symbol}, std::size_t(${symbol}_end - ${symbol})};\n")
    list(APPEND files ${file})
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}_embedded.cpp)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/embedded.cpp.in ${source} @ONLY)
  # In a unity build OBJECT_DEPENDS would be lost.
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS "${files}"
    SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${target} PRIVATE ${source})
endfunction()
