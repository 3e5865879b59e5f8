#pragma once
/// A team of threads for the rows of an executor.
#include "solver/error.hpp"
#include "variants/engine/barrier.hpp"

#include <omp.h>
#include <string>

namespace dss {

/// Whether threads have to share cores.
inline bool is_crowded(int threads) { return threads > omp_get_num_procs(); }

/// Runs work(thread, synchronise) on a team of exactly `threads` threads. With fewer, some blocks
/// of rows would silently not be computed.
/// @throws InputError if OpenMP grants fewer
template <class Work>
void run_team(int threads, Work&& work) {
  if (threads == 1) {
    work(0, [] {});
    return;
  }
  int granted = threads;
  Barrier barrier(threads, is_crowded(threads));
  omp_set_dynamic(0);
#pragma omp parallel num_threads(threads)
  {
    if (omp_get_num_threads() == threads) {
      work(omp_get_thread_num(), [&] { barrier.arrive_and_wait(); });
    } else {
#pragma omp single
      granted = omp_get_num_threads();
    }
  }
  if (granted != threads)
    throw InputError("--threads " + std::to_string(threads) + ": OpenMP grants only " +
                     std::to_string(granted) + " (OMP_THREAD_LIMIT?); give at most that");
}

} // namespace dss
