#pragma once
/// Runs on several processes: which rank of a job this process is, and how a job is started.
#include "variants/distribution.hpp"

#include <string>

namespace dss {

/// This process among those that mpirun or srun started; one alone is rank 0 of 1.
struct JobRank {
  int rank = 0, ranks = 1;
  bool is_root() const { return rank == 0; }
};
JobRank job_rank();

/// "mpi" or "mpi:VARIANT" on the command line: parts are computed by VARIANT.
struct VariantName {
  std::string name; ///< of the module
  std::string part; ///< of the module that computes a part; empty if `name` does not distribute
};
/// A plain variant on several ranks is that variant behind mpi.
VariantName parse_variant(const std::string& text, int ranks);

/// Why a job of several ranks cannot be started here, or empty.
std::string why_no_ranks();

/// Starts this very command line again on `ranks` ranks of `threads` threads by mpirun, passes on what rank 0 prints, and on
/// failure prints one line that says which rank failed. @return the exit code
/// @throws InputError if mpirun is missing
int run_on_ranks(int ranks, int threads);

} // namespace dss
