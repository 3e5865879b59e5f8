#include "variants/mpi/transports.hpp"
#include "solver/error.hpp"

#include <limits>
#include <utility>

namespace dss {

int count_of(std::size_t bytes) {
  if (bytes > std::size_t(std::numeric_limits<int>::max()))
    throw InputError(
        "a message between two parts exceeds 2 GiB; take more ranks, or --decomposition blocks");
  return int(bytes);
}

std::unique_ptr<HaloExchange> make_exchange(HaloStrategy::Transport transport,
                                            std::vector<Face> faces, MPI_Comm comm) {
  switch (transport) {
  case HaloStrategy::Transport::sendrecv:
    return make_sendrecv_exchange(std::move(faces), comm);
  case HaloStrategy::Transport::messages:
    return make_message_exchange(std::move(faces), comm);
  case HaloStrategy::Transport::shared:
    break;
  }
  return make_shared_exchange(std::move(faces), comm);
}

} // namespace dss
