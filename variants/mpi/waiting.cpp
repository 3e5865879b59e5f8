#include "variants/mpi/waiting.hpp"
#include "variants/mpi/watch.hpp"

namespace dss {
namespace {

double waited_s = 0; ///< waited by this rank in exchanges [s]

} // namespace

Waiting::Waiting(int rank) : start_s_(Watch::now_s()), rank_(rank) {
  if (Watch* watch = Watch::current()) watch->begin_waiting(rank, start_s_);
}

Waiting::~Waiting() {
  const double end_s = Watch::now_s();
  if (rank_ != for_all) waited_s += end_s - start_s_;
  if (Watch* watch = Watch::current()) watch->end_waiting(end_s);
}

double Waiting::total_s() { return waited_s; }

} // namespace dss
