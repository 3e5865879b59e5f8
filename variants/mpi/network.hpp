#pragma once
/// What a message between ranks costs here, by a short ping-pong.
#include "variants/distribution.hpp"

#include <mpi.h>

namespace dss {

/// The slowest pair (0, 1), (2, 3), ... of a communicator; zeros for one rank. Collective.
Network measure_network(MPI_Comm comm);

} // namespace dss
