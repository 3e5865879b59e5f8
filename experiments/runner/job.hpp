#pragma once
/// Runs on several processes: which rank of a job this process is, and how a job is started.
#include "variants/distribution.hpp"

#include <string>
#include <vector>

namespace dss {

/// This process among those that mpirun or srun started; one alone is rank 0 of 1.
struct JobRank {
  int rank = 0, ranks = 1;
  bool is_started = false; ///< by mpirun or srun, perhaps as the only one
  bool is_root() const { return rank == 0; }
};
JobRank job_rank();
/// @throws InputError in a task that srun started without telling MPI: each would run by itself and write the same files
void require_usable_job();

/// "mpi" or "mpi:VARIANT" on the command line: parts are computed by VARIANT.
struct VariantName {
  std::string name; ///< of the module
  std::string part; ///< of the module that computes a part; empty if `name` does not distribute
};
/// A plain variant on several ranks is that variant behind mpi.
VariantName parse_variant(const std::string& text, int ranks);

/// Why a job of several ranks cannot be started here, or empty.
std::string why_no_ranks();

/// What a job of this program left.
struct JobResult {
  int exit_code = 0; ///< as this program's own
  std::string output, error;
  std::string failure; ///< one line that says which rank failed and how, or empty
};

/// Largest number of ranks that this program starts itself; more are for mpirun with a list of hosts.
int most_ranks_here();

/// Runs this program with these arguments on `ranks` ranks of `threads` threads by mpirun.
/// @throws InputError if mpirun is missing
JobResult run_job(int ranks, int threads, const std::vector<std::string>& arguments);

/// This very command line, as a job; prints what it says. @return the exit code
int run_on_ranks(int ranks, int threads);

} // namespace dss
