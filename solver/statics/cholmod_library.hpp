#pragma once
/// The library CHOLMOD, of SuiteSparse.
#include <cholmod.h>

#include <string>

namespace dss {

/// CHOLMOD's functions of the same names.
struct CholmodLibrary {
  decltype(&::cholmod_start) start;
  decltype(&::cholmod_finish) finish;
  decltype(&::cholmod_analyze) analyze;
  decltype(&::cholmod_analyze_p) analyze_p;
  decltype(&::cholmod_factorize) factorize;
  decltype(&::cholmod_change_factor) change_factor;
  decltype(&::cholmod_solve2) solve2;
  decltype(&::cholmod_free_factor) free_factor;
  decltype(&::cholmod_free_dense) free_dense;
};

/// The library. The first call loads it. Until then no thread of its BLAS is in the process, which
/// may measure other things.
/// @throws InputError if this machine does not have it
const CholmodLibrary& cholmod();

/// Empty, or why cholmod() would throw.
std::string why_no_cholmod();

/// Sets the threads of the library and of its BLAS, for the whole process. It begins with one:
/// threads that share a core with others wait for each other in every block.
/// @return the number they have then; 1 if the BLAS is not OpenBLAS
int use_cholmod_threads(int count);

/// While one lives, loops of the library run on the calling thread, if its threads are one. Some
/// would start four threads of OpenMP, whatever the environment says.
class CholmodLoops {
public:
  CholmodLoops();
  ~CholmodLoops();
  CholmodLoops(const CholmodLoops&) = delete;

private:
  int levels_ = -1; ///< nested parallel regions that OpenMP allowed before; -1: unchanged
};

} // namespace dss
