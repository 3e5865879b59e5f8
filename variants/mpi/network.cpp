#include "variants/mpi/network.hpp"

#include "variants/mpi/waiting.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace dss {
namespace {

constexpr int repetitions = 20, small_bytes = 8, large_bytes = 256 * 1024,
              eager_message = 32 * 1024;

/// Least time of a message in one direction [s].
double one_way_s(MPI_Comm comm, int rank, int partner, std::vector<std::byte>& message, int bytes) {
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < repetitions; ++n) {
    const Waiting waiting(partner);
    const double start = MPI_Wtime();
    if (rank < partner) MPI_Send(message.data(), bytes, MPI_BYTE, partner, 0, comm);
    MPI_Recv(message.data(), bytes, MPI_BYTE, partner, 0, comm, MPI_STATUS_IGNORE);
    if (rank > partner) MPI_Send(message.data(), bytes, MPI_BYTE, partner, 0, comm);
    least = std::min(least, (MPI_Wtime() - start) / 2);
  }
  return least;
}

/// Least time that a processor is busy to send a message [s].
double overhead_s(MPI_Comm comm, int rank, int partner, std::vector<std::byte>& message,
                  int bytes) {
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < repetitions; ++n) {
    const Waiting waiting(partner);
    MPI_Request request = MPI_REQUEST_NULL;
    if (rank > partner)
      MPI_Recv(message.data(), bytes, MPI_BYTE, partner, 0, comm, MPI_STATUS_IGNORE);
    const double start = MPI_Wtime();
    MPI_Isend(message.data(), bytes, MPI_BYTE, partner, 0, comm, &request);
    least = std::min(least, MPI_Wtime() - start);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
    if (rank < partner)
      MPI_Recv(message.data(), bytes, MPI_BYTE, partner, 0, comm, MPI_STATUS_IGNORE);
  }
  return least;
}

} // namespace

Network measure_network(MPI_Comm comm) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  double times[4] = {0, 0, 0, 0};
  if (const int partner = rank ^ 1; partner < ranks) {
    std::vector<std::byte> message(large_bytes);
    times[0] = one_way_s(comm, rank, partner, message, small_bytes);
    times[1] = one_way_s(comm, rank, partner, message, large_bytes);
    times[2] = overhead_s(comm, rank, partner, message, small_bytes);
    times[3] = overhead_s(comm, rank, partner, message, eager_message);
  }
  const Waiting waiting(Waiting::for_all);
  MPI_Allreduce(MPI_IN_PLACE, times, 4, MPI_DOUBLE, MPI_MAX, comm);
  return {times[0], std::max(0.0, times[1] - times[0]) / (large_bytes - small_bytes), times[2],
          std::max(0.0, times[3] - times[2]) / (eager_message - small_bytes)};
}

} // namespace dss
