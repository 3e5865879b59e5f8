# Cross compiler and libraries for aarch64. cmake/install_aarch64.sh gets both; the libraries of
# that processor are unpacked into build/aarch64-packages.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

# GCC notes that it passes pairs of doubles otherwise than before version 10.1.
set(CMAKE_CXX_FLAGS_INIT -Wno-psabi)

# Headers without code of their own, such as Eigen, are those of the host.
get_filename_component(packages ${CMAKE_CURRENT_LIST_DIR}/../build/aarch64-packages ABSOLUTE)
set(CMAKE_FIND_ROOT_PATH ${packages})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE BOTH)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)
set(ENV{PKG_CONFIG_LIBDIR} ${packages}/usr/lib/aarch64-linux-gnu/pkgconfig)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${packages})

# Where the linker and the emulator find these libraries.
set(CMAKE_BUILD_RPATH ${packages}/usr/lib/aarch64-linux-gnu ${packages}/lib/aarch64-linux-gnu)
# DT_RPATH, which old tags set, holds for libraries of libraries, too.
set(CMAKE_EXE_LINKER_FLAGS_INIT
  "-Wl,-rpath-link,${packages}/lib/aarch64-linux-gnu -Wl,--disable-new-dtags")
