/// Waiting on a simulated cluster: there is no watch, and MPI gives the simulated time.
#include "variants/mpi/waiting.hpp"

#include <map>
#include <mpi.h>

namespace dss {
namespace {

/// Time that the calling rank has waited [s]. All ranks share the globals of one process.
double& waited_s() {
  static std::map<int, double> of_ranks;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return of_ranks[rank];
}

} // namespace

Waiting::Waiting(int rank) : start_s_(MPI_Wtime()), rank_(rank) {}
Waiting::~Waiting() {
  if (rank_ != for_all) waited_s() += MPI_Wtime() - start_s_;
}
double Waiting::total_s() { return waited_s(); }

} // namespace dss
