#pragma once
/// Measures what a message between ranks costs, by a short ping-pong.
#include "variants/api/distribution.hpp"

#include <mpi.h>

namespace dss {

/// Costs between the slowest of the pairs (0, 1), (2, 3), ... of a communicator; zeros for one
/// rank. Collective.
Network measure_network(MPI_Comm comm);

} // namespace dss
