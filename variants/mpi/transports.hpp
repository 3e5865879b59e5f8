#pragma once
/// The exchanges of all transports.
#include "variants/mpi/halo_exchange.hpp"

namespace dss {

/// MPI_Sendrecv directly from and to the executor's memory, with indexed datatypes as in figure 7
/// of the paper (plain bytes if they are one piece). Neighbours exchange in rounds, by a colouring
/// of the graph of parts, so that no chain of waiting ranks forms.
std::unique_ptr<HaloExchange> make_sendrecv_exchange(std::vector<Face> faces, MPI_Comm comm);
/// Persistent messages. They use the executor's memory directly if their data is one stable piece.
std::unique_ptr<HaloExchange> make_message_exchange(std::vector<Face> faces, MPI_Comm comm);
/// Messages through a window of memory that the ranks of a node share.
/// @throws InputError if the ranks of `comm` are on several nodes
std::unique_ptr<HaloExchange> make_shared_exchange(std::vector<Face> faces, MPI_Comm comm);

/// A size in bytes as the int that MPI counts with.
/// @throws InputError for 2 GiB and more
int count_of(std::size_t bytes);

/// Makes the exchange of a transport between the ranks of `comm`. Collective.
std::unique_ptr<HaloExchange> make_exchange(HaloStrategy::Transport transport,
                                            std::vector<Face> faces, MPI_Comm comm);

} // namespace dss
