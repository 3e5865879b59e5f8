#pragma once
/// The ranks of a job, and the watch over them: a rank that dies or hangs must end the job, not hold it up.
#include "variants/mpi/waiting.hpp"

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace dss {

class Watch;

/// MPI from its first use to the end of the program. Collective calls, unless said otherwise.
class World {
public:
  /// Starts MPI on the first call. @throws InputError if it cannot be started
  static World& instance();
  static bool is_started();

  MPI_Comm comm() const { return comm_; }
  int rank() const { return rank_; }
  int ranks() const { return ranks_; }
  /// Whether all ranks share one node's memory.
  bool is_one_node() const { return node_ranks_ == ranks_; }

  std::vector<double> gather(double value);
  std::vector<std::string> gather(const std::string& text);
  /// Bitwise or over all ranks, for all: joins what each rank filled in where the others left zeros.
  void join(std::span<double> values);
  double least(double value);
  double largest(double value);
  /// Of each value, for all.
  void largest(std::span<double> values);
  void meet();
  /// See Executor::work_alone.
  void work_alone(bool is_alone);

  /// See end_variants.
  void end(int exit_code, bool is_in_order);

private:
  friend class Waiting;
  World();
  MPI_Comm comm_ = MPI_COMM_NULL, node_ = MPI_COMM_NULL;
  int rank_ = 0, ranks_ = 1, node_ranks_ = 1;
  bool is_ended_ = false;
  std::shared_ptr<Watch> watch_;
};

} // namespace dss
