#pragma once
/// Finds out which rank holds up a job. Every rank says on a board that its node shares for whom it waits; a thread of
/// each rank reads the boards and ends the job when its own rank has waited too long.
#include <mpi.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace dss {

class Watch {
public:
  static constexpr int nobody = -1;
  Watch(MPI_Comm comm, MPI_Comm node);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// From the rank's own thread, round each call that may block. Times are of the steady clock [s].
  void begin_waiting(int rank, double now_s);
  void end_waiting(double now_s);
  /// This rank works while others wait for it: they are to have patience as long as its watch lives.
  void work_alone(bool is_alone) { own_->is_alone.store(is_alone, std::memory_order_relaxed); }

private:
  /// What a rank says of itself.
  struct alignas(64) Post {
    std::atomic<int> waits_for;
    std::atomic<double> since_s;
    std::atomic<long> calls;    ///< for all: ranks that have made fewer hold the others up
    std::atomic<bool> is_alone; ///< works while others wait
    std::atomic<double> beat_s; ///< last sign of life of its watch: a stopped process gives none
  };
  void look();
  static bool is_silent(const Post& post);
  /// The rank at the end of the chain of those who wait for one another, as far as this node knows.
  int culprit() const;
  Post* post_of(int rank) const;
  std::string message(int rank) const;
  bool is_speaker(int culprit) const;

  int rank_, ranks_;
  double patience_s_;
  std::atomic<double> work_s_{0}; ///< between the last two waits: a neighbour may take as long
  double idle_since_s_ = 0;
  std::vector<int> node_ranks_; ///< numbers in `comm` of the ranks of this node
  Post* posts_ = nullptr;       ///< of this node's ranks
  Post* own_ = nullptr;
  MPI_Win window_ = MPI_WIN_NULL;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool is_stopped_ = false;
  std::thread thread_;
};

} // namespace dss
