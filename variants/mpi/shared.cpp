#include "solver/error.hpp"
#include "variants/isa/architecture.hpp"
#include "variants/mpi/transports.hpp"
#include "variants/mpi/waiting.hpp"

#include <atomic>
#include <exception>
#include <sched.h>
#include <thread>

namespace dss {
namespace {

/// A message in the sender's part of the window. Each face has two slots, used in turn, so messages
/// n and n + 2 share one. The sender writes n + 2 after it has received the neighbour's message n +
/// 1, which the neighbour sends only after it has read message n.
struct alignas(64) Slot {
  std::atomic<std::uint64_t> filled; ///< number of the message in the slot, counted from 1
};

constexpr std::size_t cache_line = 64;
std::size_t slot_size(std::size_t bytes) {
  return sizeof(Slot) + (bytes + cache_line - 1) / cache_line * cache_line;
}

class SharedExchange final : public HaloExchange {
public:
  SharedExchange(std::vector<Face> faces, MPI_Comm comm)
      : HaloExchange(std::move(faces)), comm_(comm) {
    const Waiting waiting(Waiting::for_all);
    int ranks = 1, node_ranks = 1;
    MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node_);
    MPI_Comm_size(comm, &ranks);
    MPI_Comm_size(node_, &node_ranks);
    if (node_ranks != ranks)
      throw InputError("--halo shared: the ranks are on several nodes; give --halo deep");
    is_crowded_ = unsigned(ranks) > std::thread::hardware_concurrency();
  }
  SharedExchange(const SharedExchange&) = delete;
  SharedExchange& operator=(const SharedExchange&) = delete;
  /// Collective. If an error of this rank ends it, it does not wait, since the others may never
  /// come here.
  ~SharedExchange() override {
    if (std::uncaught_exceptions() > 0) return;
    const Waiting waiting(Waiting::for_all);
    if (window_ != MPI_WIN_NULL) MPI_Win_free(&window_);
    MPI_Comm_free(&node_);
  }

  void attach(int copies, const LayoutOf& layout_of) override {
    std::vector<std::size_t> starts; // where each face's slots start in the window
    std::size_t bytes = cache_line;
    for (const Face& face : faces_) {
      channels_.emplace_back();
      for (int copy = 0; copy < copies; ++copy) {
        channels_.back().out.push_back(layout_of(face, Way::out, copy));
        channels_.back().in.push_back(layout_of(face, Way::in, copy));
      }
      starts.push_back(bytes);
      bytes += 2 * slot_size(channels_.back().out.front().size);
    }
    const Waiting waiting(Waiting::for_all);
    void* memory = nullptr;
    MPI_Win_allocate_shared(MPI_Aint(bytes), 1, MPI_INFO_NULL, node_, &memory, &window_);
    auto* const own = static_cast<std::byte*>(memory);
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for (const int turn : {0, 1}) {
        channels_[f].own[turn] =
            own + starts[f] + std::size_t(turn) * slot_size(channels_[f].out.front().size);
        new (channels_[f].own[turn]) Slot{};
      }
    find_neighbours(starts);
  }

  void send(Side side, int copy) override {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].side != side) continue;
      Channel& channel = channels_[f];
      const HaloLayout& layout = channel.out[std::size_t(copy)];
      std::byte* const slot = channel.own[channel.sent & 1];
      gather(layout, slot + sizeof(Slot));
      reinterpret_cast<Slot*>(slot)->filled.store(++channel.sent, std::memory_order_release);
      count(layout.size);
    }
  }

  void receive(Side side, int copy) override {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].side != side) continue;
      Channel& channel = channels_[f];
      const std::byte* const slot = channel.other[channel.received & 1];
      await(*reinterpret_cast<const Slot*>(slot), ++channel.received, faces_[f].rank);
      scatter(channel.in[std::size_t(copy)], slot + sizeof(Slot));
    }
  }

private:
  struct Channel {
    std::vector<HaloLayout> out, in; ///< of each copy
    std::byte* own[2] = {};
    const std::byte* other[2] = {};
    std::uint64_t sent = 0, received = 0;
  };

  /// Tells each neighbour where its messages start in this rank's part of the window.
  void find_neighbours(const std::vector<std::size_t>& starts) {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const int rank = faces_[f].rank;
      unsigned long start = starts[f], other_start = 0;
      MPI_Request request = MPI_REQUEST_NULL;
      MPI_Isend(&start, 1, MPI_UNSIGNED_LONG, rank, 0, comm_, &request);
      MPI_Recv(&other_start, 1, MPI_UNSIGNED_LONG, rank, 0, comm_, MPI_STATUS_IGNORE);
      MPI_Wait(&request, MPI_STATUS_IGNORE);
      MPI_Aint size = 0;
      int unit = 0;
      void* memory = nullptr;
      // Ranks of the only node are numbered as in comm.
      MPI_Win_shared_query(window_, rank, &size, &unit, &memory);
      const std::size_t bytes = slot_size(channels_[f].in.front().size);
      for (const std::size_t turn : {0, 1})
        channels_[f].other[turn] = static_cast<std::byte*>(memory) + other_start + turn * bytes;
    }
    MPI_Barrier(comm_); // all slots exist
  }

  void await(const Slot& slot, std::uint64_t number, int rank) const {
    if (slot.filled.load(std::memory_order_acquire) == number) return;
    const Waiting waiting(rank);
    for (int spins = 0; slot.filled.load(std::memory_order_acquire) != number; ++spins) {
      if (is_crowded_ || spins > most_spins)
        ::sched_yield();
      else
        isa::pause();
    }
  }

  static constexpr int most_spins = 2000; ///< about 20 to 100 us
  MPI_Comm comm_, node_ = MPI_COMM_NULL;
  MPI_Win window_ = MPI_WIN_NULL;
  bool is_crowded_ = false;
  std::vector<Channel> channels_;
};

} // namespace

std::unique_ptr<HaloExchange> make_shared_exchange(std::vector<Face> faces, MPI_Comm comm) {
  return std::make_unique<SharedExchange>(std::move(faces), comm);
}

} // namespace dss
