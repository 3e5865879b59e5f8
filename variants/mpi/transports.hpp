#pragma once
/// The classes behind make_exchange.
#include "variants/mpi/halo_exchange.hpp"

namespace dss {

/// MPI_Sendrecv straight from and to the executor's memory by indexed datatypes, as in figure 7 of the paper
/// (plain bytes where they are one piece). Neighbours
/// meet in rounds (a colouring of the graph of parts), so that nobody waits for a chain of others.
std::unique_ptr<HaloExchange> make_sendrecv_exchange(std::vector<Face> faces, MPI_Comm comm);
/// Persistent messages. They go straight from and to the executor's memory where that is one stable piece.
std::unique_ptr<HaloExchange> make_message_exchange(std::vector<Face> faces, MPI_Comm comm);
/// Through a window of memory that the ranks of the node share. @throws InputError if `comm` spans several nodes
std::unique_ptr<HaloExchange> make_shared_exchange(std::vector<Face> faces, MPI_Comm comm);

/// As MPI counts. @throws InputError for 2 GiB and more
int count_of(std::size_t bytes);

} // namespace dss
