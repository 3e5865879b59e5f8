#pragma once
/// What an executor of a part and the exchange between parts know of one another. The executor says when; the exchange
/// (variants/mpi) says how.
#include "solver/decomposition/part.hpp"

#include <cstddef>
#include <cstring>
#include <vector>

namespace dss {

/// Where elements lie in an executor's memory, in the order of a message.
struct HaloLayout {
  struct Piece {
    std::byte* at = nullptr;
    std::size_t offset = 0, count = 0; ///< bytes; offset into the message
  };
  std::vector<Piece> pieces;
  std::size_t size = 0; ///< of the message
  /// The executor touches them in no other way than by its own copy: a message may be under way while other copies are
  /// computed. Otherwise they are only good until the next computation.
  bool is_stable = false;
};

/// Copies between memory and a message.
inline void gather(const HaloLayout& layout, std::byte* message) {
  for (const auto& piece : layout.pieces) std::memcpy(message + piece.offset, piece.at, piece.count);
}
inline void scatter(const HaloLayout& layout, const std::byte* message) {
  for (const auto& piece : layout.pieces) std::memcpy(piece.at, message + piece.offset, piece.count);
}

/// The halo of one part as its executor sees it. An executor may keep several copies of its elements (stages, parities
/// of the step) and numbers them as it likes: messages between two parts are matched by their order. All calls come from
/// the thread that made the executor.
class Halo {
public:
  virtual ~Halo() = default;
  /// The own elements that neighbours on this side read are written in this copy.
  virtual void send(Side side, int copy) = 0;
  /// Returns when the neighbours' elements on this side are in this copy, and what was sent to that side may be
  /// overwritten. @throws if they cannot come any more
  virtual void receive(Side side, int copy) = 0;
  /// This part now does what may take long, such as compiling, while its neighbours wait; or no longer does.
  virtual void work_alone(bool is_alone) { (void)is_alone; }
};

/// Makes an executor compute one part of a problem.
struct PartSetup {
  const Part& part; ///< Setup::problem is part.problem
  Halo& halo;
  bool is_every_stage = false; ///< exchange after every stage (one layer of halo); else once a step (a layer a stage)
  bool is_overlapped = false;  ///< compute what needs no halo first, and what neighbours wait for as early as possible
};

/// While it lives, a part works alone. Of a whole problem (null) nobody has to know.
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

/// Null for a whole problem, or a part that has no neighbours, which is computed as one.
inline const PartSetup* part_with_neighbours(const PartSetup* setup) {
  return setup == nullptr || setup->part.neighbours.empty() ? nullptr : setup;
}

/// One step of a part in the order that hides messages best: the rows that the upper neighbours wait for are a pass of
/// their own and come first (if it is split), those that the lower ones wait for come first in the other pass.
/// @param run_upper  computes the upper pass  @param run_lower  computes the lower pass; calls its argument when the
/// lower edge is done
template <class RunUpper, class RunLower>
void overlapped_step(Halo& halo, int copy, int next_copy, bool is_last, bool is_split, RunUpper&& run_upper,
                     RunLower&& run_lower) {
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
