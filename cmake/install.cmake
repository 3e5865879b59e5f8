# What `cmake --install` puts under PREFIX besides the program and its variants: what they read, what a variant built outside this tree needs, and help.
include(CMakePackageConfigHelpers)

# The program finds these from its own place: PREFIX may move. Where they are in the source tree they are under share/dssbench.
install(DIRECTORY experiments DESTINATION share/dssbench FILES_MATCHING PATTERN "*.json" PATTERN "*.xml" PATTERN runner EXCLUDE PATTERN microbenchmarks EXCLUDE)
install(FILES solver/scene/scene.schema.json LICENSE CITATION.cff DESTINATION share/dssbench)
install(DIRECTORY examples DESTINATION share/dssbench)

# Headers by the paths that they include one another by, the row engine as source, and the solver, for variants/api.hpp and who implements it.
install(DIRECTORY kernels solver DESTINATION include/dssbench FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h")
install(DIRECTORY variants/engine DESTINATION include/dssbench/variants FILES_MATCHING PATTERN "*.hpp" PATTERN "*.cpp")
file(GLOB interface CONFIGURE_DEPENDS variants/*.hpp)
install(FILES ${interface} DESTINATION include/dssbench/variants)
install(TARGETS dss_options dss_solver EXPORT dssbench ARCHIVE DESTINATION lib/dssbench)
install(EXPORT dssbench NAMESPACE dssbench:: FILE dssbench-targets.cmake DESTINATION lib/cmake/dssbench)
configure_package_config_file(cmake/dssbench-config.cmake.in ${PROJECT_BINARY_DIR}/dssbench-config.cmake INSTALL_DESTINATION lib/cmake/dssbench)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/dssbench-config-version.cmake COMPATIBILITY ExactVersion)
install(FILES ${PROJECT_BINARY_DIR}/dssbench-config.cmake ${PROJECT_BINARY_DIR}/dssbench-config-version.cmake cmake/dssbench_variant.cmake variants/exports.map
  DESTINATION lib/cmake/dssbench)

# Made by the program itself, once it is installed, from the description of its command line.
install(CODE [[
  set(prefix $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX})
  function(made_by_program file)
    message(STATUS "Installing: ${prefix}/${file}")
    cmake_path(GET file PARENT_PATH folder)
    file(MAKE_DIRECTORY ${prefix}/${folder})
    execute_process(COMMAND ${prefix}/bin/dssbench ${ARGN} OUTPUT_FILE ${prefix}/${file} COMMAND_ERROR_IS_FATAL ANY)
  endfunction()
  made_by_program(share/man/man1/dssbench.1 help --man)
  made_by_program(share/bash-completion/completions/dssbench completion bash)
  made_by_program(share/zsh/site-functions/_dssbench completion zsh)
  made_by_program(share/fish/vendor_completions.d/dssbench.fish completion fish)
]])
