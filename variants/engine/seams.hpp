#pragma once
/// What blocks of rows do where they meet, so that they compute the steps of all rows together.
#include "variants/engine/pass_order.hpp"

#include <unordered_map>
#include <unordered_set>

namespace dss {

/// The places of the rows of each sweep of each block: [block][sweep].
///
/// Recomputed: those that the block's rows depend on. Handed over: sweep n has the block's rows, n
/// halos higher. So the start of a block needs nothing of the block below it in the same pass, and
/// its end finds what the block above computed at its start. The first and the last block also have
/// what the outermost own rows of a part depend on.
/// @param rows    of the whole problem, or of the part with its halo
/// The rows that sweep n of a pass computes, so that its last sweep has the rows `last`.
SweepRows rows_of_sweep(SweepRows last, int n, int sweeps, int halo, int rows);

/// @param sweeps  of a pass
std::vector<std::vector<SweepRows>> block_sweeps(const RowDivision& division, int rows, int sweeps);

/// What a pass reads and writes, as far as other blocks may touch it too.
struct PassReads {
  StepSweeps sweeps; ///< of a step
  /// Of each stage, the stages whose outputs the update reads.
  std::vector<std::vector<int>> increments;
  std::span<const LinkedRows> extra; ///< rows of the extra links
  std::span<const int> sizes = {};   ///< packs of each row's place; empty: each has one
};

/// Which outputs blocks hand over to others, and which tasks wait for which.
///
/// One rule orders everything that two blocks touch and one of them writes. In a pass the upper
/// block comes first. So what a task of the lower block reads waits until the upper block wrote it
/// in the same pass, and what it writes until the upper block read it; a task of the upper block
/// waits for the lower block's pass before. No circle can arise.
class Seams {
public:
  static constexpr int nowhere = -1;

  struct Wait {
    int task;  ///< of the block that waits
    int block; ///< that it waits for
    bool is_for_pass_before;
    int event; ///< of that block, counted from 1 in each pass
  };

  /// @param division  outlives this object, as the lattice does
  /// @param sweeps    from block_sweeps
  /// @param orders    of the tasks of each block
  Seams(const Lattice& lattice, const RowDivision& division,
        std::vector<std::vector<SweepRows>> sweeps, PassReads reads,
        const std::vector<std::vector<PassTask>>& orders);
  /// The block that computes a row in a sweep. @param reader  a block that reads it
  int owner(int sweep, int row, int reader) const;
  /// The place of an output of a block that others read [packs]; nowhere if none does. An output is
  /// that of a stage of a row; or, of a method with one stage, the row before a sweep overwrites
  /// it, whose number is that of the sweep. It keeps its place for the whole pass.
  int handed_over(int block, int output, int row) const;
  /// What all these places take [packs].
  int handed_over_size(int block) const { return blocks_[std::size_t(block)].size; }
  /// When all tasks are made. Only waits and events are left.
  void forget_outputs();
  /// In the order of the tasks.
  std::span<const Wait> waits(int block) const { return blocks_[std::size_t(block)].waits; }
  /// The tasks after which a block tells that it has come so far, in their order.
  std::span<const int> events(int block) const { return blocks_[std::size_t(block)].events; }

private:
  using Key = std::uint64_t;
  struct BlockSeams {
    std::unordered_map<Key, int> places; ///< of outputs that are handed over
    int size = 0;                        ///< of all places
    std::vector<Wait> waits;
    std::vector<int> events;
  };
  /// The last tasks of a pass in which a block touches something, and writes it; -1: it does not.
  struct LastTouch {
    int block, task, writer;
  };
  using Touches = std::unordered_map<Key, std::vector<LastTouch>>;
  static constexpr int state = -1; ///< as an output
  /// Where a task reads a row: the number of an output, or `state`.
  int input_of(int block, const PassTask& task, int row) const;
  /// The sweep that writes an output.
  int writer(int output) const {
    return reads_.sweeps.stages == 1 ? output : reads_.sweeps.of_stage(output);
  }
  static Key key(int output, int row) { return Key(unsigned(row)) << 32 | unsigned(output + 1); }
  bool is_near(int row) const { return is_near_[std::size_t(division_.order.place(row))]; }
  void find_overwritten(const std::vector<std::vector<PassTask>>& orders);
  template <class Visit>
  void each_touch(int block, const PassTask& task, Visit&& visit) const;
  void hand_over(const std::vector<std::vector<PassTask>>& orders);
  Touches last_touches(const std::vector<std::vector<PassTask>>& orders) const;
  void make_waits(const std::vector<std::vector<PassTask>>& orders);
  void make_events();

  const Lattice& lattice_;
  const RowDivision& division_;
  const std::vector<std::vector<SweepRows>> sweeps_;
  const PassReads reads_;
  std::vector<bool> is_near_; ///< [place]: rows that several blocks may touch
  /// Of a method with one stage: the rows that a sweep overwrites. A part leaves rows of other
  /// parts alone.
  std::unordered_set<Key> overwritten_;
  std::vector<BlockSeams> blocks_;
};

} // namespace dss
