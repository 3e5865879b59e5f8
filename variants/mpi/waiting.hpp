#pragma once
#include "variants/mpi/all_ranks.hpp"

namespace dss {

/// While an object lives, this rank waits for another rank, or for all. The watch then knows for
/// whom and for how long.
class Waiting {
public:
  static constexpr int for_all = all_ranks;
  explicit Waiting(int rank);
  ~Waiting();
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;
  /// Time that this rank has waited in exchanges so far, without waits for all [s].
  static double total_s();

private:
  double start_s_;
  int rank_;
};

} // namespace dss
