#include "variants/mpi/halo_exchange.hpp"

#include <utility>

namespace dss {

std::vector<Face> faces_of(const Part& part) {
  std::vector<Face> faces;
  for (const Neighbour& neighbour : part.neighbours)
    faces.push_back({neighbour.part, side_of(part, neighbour), faces.size()});
  return faces;
}

TimedHalo::TimedHalo(HaloExchange& exchange, std::function<void(bool)> tell_alone)
    : exchange_(exchange), tell_alone_(std::move(tell_alone)) {
  for (const Face& face : exchange.faces()) has_side_[int(face.side)] = true;
  if (!exchange.faces().empty())
    has_side_[int(all_sides[0])] = true; // sendrecv serves all sides in this call
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

} // namespace dss
