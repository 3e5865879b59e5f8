#include "variants/mpi/halo_exchange.hpp"

#include "solver/error.hpp"
#include "variants/mpi/transports.hpp"

#include <limits>
#include <utility>

namespace dss {

std::vector<Face> faces_of(const Part& part) {
  std::vector<Face> faces;
  for (const Neighbour& neighbour : part.neighbours)
    faces.push_back({neighbour.part, side_of(part, neighbour), faces.size()});
  return faces;
}

int count_of(std::size_t bytes) {
  if (bytes > std::size_t(std::numeric_limits<int>::max()))
    throw InputError("a message between two parts exceeds 2 GiB; take more ranks, or --decomposition blocks");
  return int(bytes);
}

TimedHalo::TimedHalo(HaloExchange& exchange, std::function<void(bool)> tell_alone)
    : exchange_(exchange), tell_alone_(std::move(tell_alone)) {
  for (const Face& face : exchange.faces()) has_side_[int(face.side)] = true;
  if (!exchange.faces().empty()) has_side_[int(all_sides[0])] = true; // sendrecv serves all sides on this call
}

void TimedHalo::send(Side side, int copy) {
  if (!has_side_[int(side)]) return;
  const double start_s = MPI_Wtime();
  exchange_.send(side, copy);
  total_s_ += MPI_Wtime() - start_s;
}

void TimedHalo::receive(Side side, int copy) {
  if (!has_side_[int(side)]) return;
  const double start_s = MPI_Wtime();
  exchange_.receive(side, copy);
  total_s_ += MPI_Wtime() - start_s;
}

std::unique_ptr<HaloExchange> make_exchange(HaloStrategy::Transport transport, std::vector<Face> faces, MPI_Comm comm) {
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
