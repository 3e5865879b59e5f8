#pragma once
/// The ranks of a job, and the watch over them: a rank that dies or hangs must end the job, not
/// delay it for ever.
#include "variants/mpi/waiting.hpp"

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace dss {

class Watch;

/// MPI from its first use to the end of the program. Calls are collective unless they say
/// otherwise.
class World {
public:
  /// Starts MPI in the first call.
  /// @throws InputError if MPI cannot start
  static World& instance();
  static bool is_started();
  /// Whether mpirun or srun started this process.
  static bool is_in_job();

  MPI_Comm comm() const { return comm_; }
  int rank() const { return rank_; }
  int ranks() const { return ranks_; }
  /// Whether all ranks are on one node.
  bool is_one_node() const { return node_ranks_ == ranks_; }

  /// The value, or text, of every rank, in the order of ranks.
  std::vector<double> gather(double value);
  std::vector<std::string> gather(const std::string& text);
  /// Bitwise or over all ranks; every rank gets the result. It joins values that each rank has
  /// filled in where the others left zeros.
  void join(std::span<double> values);
  /// The smallest, or largest, value of all ranks.
  double least(double value);
  double largest(double value);
  /// Replaces each value by the largest of all ranks.
  void largest(std::span<double> values);
  /// Returns when all ranks have called it.
  void meet();
  /// See Executor::work_alone. Not collective.
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
