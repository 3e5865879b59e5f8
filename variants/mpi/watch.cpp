#include "variants/mpi/watch.hpp"

#include "variants/mpi/all_ranks.hpp"
#include "variants/mpi/start_guard.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fmt/format.h>

namespace dss {
namespace {

constexpr double patience_over_nodes_s = 60;
constexpr double silence_s = 3; ///< a watch gives a sign of life five times a second
constexpr double grace_s = 1.5; ///< time for ranks nearer to the culprit to report it first

} // namespace

Watch* Watch::current_ = nullptr;

double Watch::now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Watch::Watch(MPI_Comm comm, MPI_Comm node) : patience_s_(patience_s()), idle_since_s_(now_s()) {
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &ranks_);
  int node_rank = 0, node_size = 1;
  MPI_Comm_rank(node, &node_rank);
  MPI_Comm_size(node, &node_size);
  // Ranks of other nodes have no entry on this node's board, so they get more time.
  if (node_size < ranks_ && std::getenv("DSSBENCH_PATIENCE_S") == nullptr)
    patience_s_ = patience_over_nodes_s;
  node_ranks_.resize(std::size_t(node_size));
  MPI_Allgather(&rank_, 1, MPI_INT, node_ranks_.data(), 1, MPI_INT, node);
  const MPI_Aint bytes = node_rank == 0 ? MPI_Aint(sizeof(Post)) * node_size : 0;
  void* memory = nullptr;
  MPI_Win_allocate_shared(bytes, 1, MPI_INFO_NULL, node, &memory, &window_);
  MPI_Aint size = 0;
  int unit = 0;
  MPI_Win_shared_query(window_, 0, &size, &unit, &memory);
  posts_ = static_cast<Post*>(memory);
  own_ = new (&posts_[node_rank]) Post{nobody, 0.0, 0, false, now_s()};
  MPI_Barrier(node);
  thread_ = std::thread([this] { look(); });
  current_ = this;
}

Watch::~Watch() {
  current_ = nullptr;
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
  }
  stopped_.notify_one();
  thread_.join();
  MPI_Win_free(&window_);
}

void Watch::begin_waiting(int rank, double now) {
  work_s_.store(now - idle_since_s_, std::memory_order_relaxed);
  own_->since_s.store(now, std::memory_order_relaxed);
  if (rank == all_ranks) own_->calls.fetch_add(1, std::memory_order_relaxed);
  own_->waits_for.store(rank, std::memory_order_release);
}

void Watch::end_waiting(double now) {
  own_->waits_for.store(nobody, std::memory_order_release);
  idle_since_s_ = now;
}

Watch::Post* Watch::post_of(int rank) const {
  const auto found = std::find(node_ranks_.begin(), node_ranks_.end(), rank);
  return found == node_ranks_.end() ? nullptr : &posts_[found - node_ranks_.begin()];
}

bool Watch::is_silent(const Post& post) {
  return now_s() - post.beat_s.load(std::memory_order_relaxed) > silence_s;
}

int Watch::culprit() const {
  for (const int rank : node_ranks_)
    if (is_silent(*post_of(rank))) return rank;
  int rank = rank_;
  for (int steps = 0; steps < ranks_; ++steps) {
    const Post* const post = post_of(rank);
    if (post == nullptr) return rank;
    int next = post->waits_for.load(std::memory_order_acquire);
    if (next == nobody) return rank;
    if (next == all_ranks) { // which rank has not reached this call yet?
      const auto late = std::min_element(node_ranks_.begin(), node_ranks_.end(), [&](int a, int b) {
        return post_of(a)->calls.load(std::memory_order_relaxed) <
               post_of(b)->calls.load(std::memory_order_relaxed);
      });
      if (*late == rank || post_of(*late)->calls.load() >= post->calls.load())
        return nobody; // it is on another node
      next = *late;
    }
    rank = next;
  }
  return nobody; // the ranks wait for one another
}

/// Only one rank reports: the first of this node that waits for the culprit itself.
bool Watch::is_speaker(int culprit) const {
  for (const int rank : node_ranks_) {
    if (rank == culprit) continue;
    const int waits_for = post_of(rank)->waits_for.load(std::memory_order_acquire);
    if (waits_for == culprit || waits_for == all_ranks) return rank == rank_;
  }
  return false;
}

std::string Watch::message(int rank) const {
  if (rank == nobody)
    return fmt::format("rank {} of {} has waited too long for all others", rank_, ranks_);
  return fmt::format("rank {} of {} has not answered for {:.0f} s (rank {} waits for it)", rank,
                     ranks_, now_s() - own_->since_s.load(std::memory_order_relaxed), rank_);
}

void Watch::look() {
  std::unique_lock lock(mutex_);
  while (!stopped_.wait_for(lock, std::chrono::milliseconds(200), [&] { return is_stopped_; })) {
    own_->beat_s.store(now_s(), std::memory_order_relaxed);
    if (own_->waits_for.load(std::memory_order_acquire) == nobody) continue;
    const double limit_s = std::max(patience_s_, 5 * work_s_.load(std::memory_order_relaxed));
    const double over_s = now_s() - own_->since_s.load(std::memory_order_relaxed) - limit_s;
    if (over_s < 0) continue;
    const int found = culprit();
    const Post* const post = found == nobody ? nullptr : post_of(found);
    if (post != nullptr && post->is_alone.load(std::memory_order_relaxed) && !is_silent(*post))
      continue;
    if (found == rank_ || (!is_speaker(found) && over_s < grace_s)) continue;
    end_job(message(found));
  }
}

} // namespace dss
