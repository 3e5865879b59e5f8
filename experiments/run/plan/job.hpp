#pragma once
/// Runs on several processes: finds out which rank of a job this process is, and starts jobs.
#include "variants/api/distribution.hpp"

#include <string>
#include <vector>

namespace dss {

/// Rank of this process in a job that mpirun or srun started. A process without a job is rank 0 of
/// 1.
struct JobRank {
  int rank = 0, ranks = 1;
  bool is_started = false; ///< started by mpirun or srun, even if there is only one rank
  bool is_root() const { return rank == 0; }
};
/// Reads this process's rank from the environment variables of mpirun or srun.
JobRank job_rank();
/// @throws InputError if srun started several tasks without MPI support: each task would then run
/// the whole problem and write the same files
void require_usable_job();

/// The value "mpi" or "mpi:VARIANT" on the command line: VARIANT computes the parts.
struct VariantName {
  std::string name; ///< name of the variant's module
  std::string part; ///< variant that computes a part; empty if `name` is not distributed
};
/// Splits the name of a variant. On several ranks, a plain variant means "mpi:VARIANT".
VariantName parse_variant(const std::string& text, int ranks);

/// Reason why a job of several ranks cannot be started here; empty if it can.
std::string why_no_ranks();

/// Result of a job.
struct JobResult {
  int exit_code = 0; ///< exit code as this program defines it
  std::string output, error;
  std::string failure; ///< one line that says which rank failed and how; empty if none failed
};

/// Largest number of ranks that this program starts itself. For more ranks, the user starts mpirun
/// with a list of hosts.
int most_ranks_here();

/// Runs this program by mpirun on `ranks` ranks, each with `threads` threads.
/// @throws InputError if mpirun is missing
JobResult run_job(int ranks, int threads, const std::vector<std::string>& arguments);

/// Runs the present command line as a job and prints its output. @return the exit code
int run_on_ranks(int ranks, int threads);

} // namespace dss
