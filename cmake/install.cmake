# What `cmake --install` puts under PREFIX besides the program and its variants: the files that they
# read, the files that a variant built outside this tree needs, and help.
include(CMakePackageConfigHelpers)

# The program finds these files from its own place, so PREFIX may be moved. Under share/dssbench
# they have the paths of the source tree.
install(DIRECTORY experiments DESTINATION share/dssbench
  FILES_MATCHING PATTERN "*.json" PATTERN "*.xml")
install(FILES LICENSE CITATION.cff DESTINATION share/dssbench)
# The "$schema" of scenes and studies is a relative path.
install(FILES solver/scene/scene.schema.json DESTINATION share/dssbench/solver/scene)
install(FILES solver/json/names.schema.json DESTINATION share/dssbench/solver/json)
install(DIRECTORY examples DESTINATION share/dssbench)

# For variants that implement variants/api/api.hpp: the headers, with the paths of their #include
# lines; the sources of the row engine; the solver.
install(DIRECTORY kernels solver DESTINATION include/dssbench
  FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h")
install(DIRECTORY variants/engine DESTINATION include/dssbench/variants
  FILES_MATCHING PATTERN "*.hpp" PATTERN "*.cpp" PATTERN "*.cpp.in")
install(DIRECTORY variants/api variants/loading variants/cost variants/isa
  DESTINATION include/dssbench/variants FILES_MATCHING PATTERN "*.hpp" PATTERN "isa.json")
install(TARGETS dss_options dss_solver EXPORT dssbench ARCHIVE DESTINATION lib/dssbench)
install(EXPORT dssbench NAMESPACE dssbench:: FILE dssbench-targets.cmake
  DESTINATION lib/cmake/dssbench)
configure_package_config_file(cmake/dssbench-config.cmake.in
  ${PROJECT_BINARY_DIR}/dssbench-config.cmake INSTALL_DESTINATION lib/cmake/dssbench)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/dssbench-config-version.cmake
  COMPATIBILITY ExactVersion)
install(FILES ${PROJECT_BINARY_DIR}/dssbench-config.cmake
  ${PROJECT_BINARY_DIR}/dssbench-config-version.cmake cmake/dssbench_variant.cmake
  variants/exports.map DESTINATION lib/cmake/dssbench)

# The installed program writes these files itself, from the description of its command line.
install(CODE [[
  set(prefix $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX})
  function(made_by_program file)
    message(STATUS "Installing: ${prefix}/${file}")
    cmake_path(GET file PARENT_PATH folder)
    file(MAKE_DIRECTORY ${prefix}/${folder})
    execute_process(COMMAND ${prefix}/bin/dssbench ${ARGN} OUTPUT_FILE ${prefix}/${file}
      COMMAND_ERROR_IS_FATAL ANY)
  endfunction()
  made_by_program(share/man/man1/dssbench.1 help --man)
  made_by_program(share/bash-completion/completions/dssbench completion bash)
  made_by_program(share/zsh/site-functions/_dssbench completion zsh)
  made_by_program(share/fish/vendor_completions.d/dssbench.fish completion fish)
]])
