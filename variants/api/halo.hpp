#pragma once
/// The interface between the executor of a part and the exchange of halos. The executor decides
/// when to exchange; the exchange (variants/mpi, variants/hybrid) decides how.
#include "solver/decomposition/part.hpp"

#include <cstddef>
#include <cstring>
#include <vector>

namespace dss {

/// Where elements lie in an executor's memory, in the order of a message.
struct HaloLayout {
  struct Piece {
    std::byte* at = nullptr;
    /// Offset into the message, and length, both in bytes.
    std::size_t offset = 0, count = 0;
  };
  std::vector<Piece> pieces;
  std::size_t size = 0; ///< of the message [bytes]
  /// true: the executor uses this memory only when it computes this copy, so a message may be under
  /// way while it computes other copies. false: the data is valid only until the next computation.
  bool is_stable = false;
};

/// Copies from the executor's memory into a message.
inline void gather(const HaloLayout& layout, std::byte* message) {
  for (const auto& piece : layout.pieces)
    std::memcpy(message + piece.offset, piece.at, piece.count);
}
/// Copies from a message into the executor's memory.
inline void scatter(const HaloLayout& layout, const std::byte* message) {
  for (const auto& piece : layout.pieces)
    std::memcpy(piece.at, message + piece.offset, piece.count);
}

/// The halo of one part, as its executor sees it. An executor may keep several copies of its
/// elements, for example one for each stage, and numbers them as it likes: messages between two
/// parts are matched by their order. All calls come from the thread that made the executor.
class Halo {
public:
  virtual ~Halo() = default;
  /// Sends the own elements of this copy that neighbours on this side read. The executor has
  /// written them.
  virtual void send(Side side, int copy) = 0;
  /// Returns when the neighbours' elements on this side are in this copy. What was sent to that
  /// side may then be overwritten.
  /// @throws if the elements cannot arrive any more
  virtual void receive(Side side, int copy) = 0;
  /// true: this part begins a task during which its neighbours may wait long, such as compiling.
  /// false: the task is over.
  virtual void work_alone(bool is_alone) { (void)is_alone; }
};

/// Tells an executor that it computes one part of a problem.
struct PartSetup {
  const Part& part; ///< Setup::problem is part.problem
  Halo& halo;
  /// true: exchange after every stage, one layer of halo for each sweep of a stage. false: exchange
  /// once a step, one layer for each sweep of the step (step_sweeps.hpp).
  bool is_every_stage = false;
  /// true: compute the rows that read no halo first, unless elements have pressures, and the rows
  /// that neighbours wait for as early as possible.
  bool is_overlapped = false;
};

/// Declares, while it lives, that a part works alone (Halo::work_alone). Null: a whole problem,
/// which has no neighbours to tell.
class PartWorksAlone {
public:
  explicit PartWorksAlone(const PartSetup* part) : part_(part) { tell(true); }
  PartWorksAlone(const PartWorksAlone&) = delete;
  PartWorksAlone& operator=(const PartWorksAlone&) = delete;
  ~PartWorksAlone() { tell(false); }

private:
  void tell(bool is_alone) {
    if (part_ != nullptr) part_->halo.work_alone(is_alone);
  }
  const PartSetup* part_;
};

/// @return null for a whole problem and for a part without neighbours, which is computed like one
inline const PartSetup* part_with_neighbours(const PartSetup* setup) {
  return setup == nullptr || setup->part.neighbours.empty() ? nullptr : setup;
}

/// One step of a part, in the order that hides messages best. If the step is split, the rows that
/// the upper neighbours wait for are a separate first pass. The other pass begins with the rows
/// that the lower neighbours wait for.
/// @param copy, next_copy  copies before and after the step
/// @param is_last          the last step of a call, after which nothing is sent
/// @param run_upper        computes the upper pass
/// @param run_lower        computes the lower pass; calls its argument when the lower edge is
/// finished
template <class RunUpper, class RunLower>
void overlapped_step(Halo& halo, int copy, int next_copy, bool is_last, bool is_split,
                     RunUpper&& run_upper, RunLower&& run_lower) {
  const auto send = [&](Side side) {
    if (!is_last) halo.send(side, next_copy);
  };
  halo.receive(Side::among, copy);
  halo.receive(Side::upper, copy);
  if (is_split) {
    run_upper();
    send(Side::upper);
  }
  halo.receive(Side::lower, copy);
  run_lower([&] { send(Side::lower); });
  if (!is_split) send(Side::upper);
  send(Side::among);
}

} // namespace dss
