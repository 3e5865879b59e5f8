#pragma once
/// The watch finds the rank that holds up a job. Every rank writes on a board in its node's shared
/// memory for whom it waits. A thread of each rank reads the board, and ends the job when its own
/// rank has waited too long.
#include <mpi.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace dss {

/// The watch of one rank.
class Watch {
public:
  static constexpr int nobody = -1;
  Watch(MPI_Comm comm, MPI_Comm node);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  /// The watch of this process, or null.
  static Watch* current() { return current_; }
  /// The steady clock [s].
  static double now_s();

  /// The rank's own thread calls these two round each call that may block. Times: steady clock [s].
  void begin_waiting(int rank, double now_s);
  void end_waiting(double now_s);
  /// This rank works while others wait for it. They are patient as long as its watch lives.
  void work_alone(bool is_alone) { own_->is_alone.store(is_alone, std::memory_order_relaxed); }

private:
  /// A rank's entry on the board.
  struct alignas(64) Post {
    std::atomic<int> waits_for;
    std::atomic<double> since_s;
    /// Calls that wait for all; a rank with fewer calls holds up the others.
    std::atomic<long> calls;
    std::atomic<bool> is_alone; ///< works while others wait
    std::atomic<double> beat_s; ///< last sign of life of its watch; a stopped process gives none
  };
  void look();
  static bool is_silent(const Post& post);
  /// The rank at the end of the chain of waiting ranks, as far as this node knows; or nobody.
  int culprit() const;
  Post* post_of(int rank) const;
  std::string message(int rank) const;
  /// Whether this rank is the one that reports the culprit.
  bool is_speaker(int culprit) const;

  static Watch* current_;
  int rank_, ranks_;
  double patience_s_;
  /// Compute time between the last two waits; a neighbour may take as long [s].
  std::atomic<double> work_s_{0};
  double idle_since_s_ = 0;
  std::vector<int> node_ranks_; ///< the ranks of this node, by their numbers in `comm`
  Post* posts_ = nullptr;       ///< entries of this node's ranks
  Post* own_ = nullptr;
  MPI_Win window_ = MPI_WIN_NULL;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool is_stopped_ = false;
  std::thread thread_;
};

} // namespace dss
