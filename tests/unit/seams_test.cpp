/// Blocks of rows that hand over to one another, computed in random interleavings.
#include "variants/engine/seams.hpp"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <random>
#include <tuple>

namespace dss {
namespace {

Lattice porous_bodies(int ny, int nz) {
  Lattice lattice;
  std::mt19937 generator(unsigned(ny * nz));
  for (const int body : {0, 1}) {
    VoxelGrid grid{5, ny, nz, std::vector<std::uint8_t>(std::size_t(5 * ny * nz))};
    for (auto& cell : grid.occupied) cell = generator() % 4 != 0;
    append_body(lattice, grid, body);
  }
  return lattice;
}

/// Computes passes of all blocks. What a task reads must be of its own pass and sweep. The state of
/// a row is the number of steps that have written it. A pressure is the pass and sweep that found
/// it.
class Passes {
public:
  /// @param form  in row order: the middle half of the rows belong to the blocks, the others to
  ///   other parts
  Passes(const Lattice& lattice, const std::vector<LinkedRows>& extra, StepSweeps of_step,
         int steps, int blocks, SweepForm form)
      : lattice_(lattice), extra_(extra), of_step_(of_step), steps_(steps),
        state_(lattice.rows.size()), pass_(std::size_t(blocks)), task_(pass_.size()),
        events_(pass_.size()) {
    const bool is_part = form.is_in_row_order;
    if (!is_part) division_.order = RowOrder(lattice, extra);
    division_.halo = division_.order.halo(lattice, extra);
    division_.seams = SeamKind::handed_over;
    const int rows = int(lattice.rows.size());
    const int begin = is_part ? rows / 4 : 0, end = is_part ? rows - rows / 4 : rows;
    for (int b = 0; b <= blocks; ++b) division_.cuts.push_back(begin + (end - begin) * b / blocks);
    const auto all = block_sweeps(division_, rows, steps * of_step.count());
    for (const auto& of_block : all)
      orders_.push_back(order_pass(lattice, division_.order, of_block, form, extra, of_step));
    reads_.sweeps = of_step;
    reads_.increments.resize(std::size_t(of_step.stages));
    if (of_step.stages == 4) reads_.increments.back() = {0, 1, 2};
    reads_.extra = extra_;
    seams_.emplace(lattice, division_, all, reads_, orders_);
  }
  /// Computes the next task of a block, unless it must wait or all passes are done.
  /// @return whether it did
  bool compute_next(int block, int passes) {
    const auto b = std::size_t(block);
    if (pass_[b] == passes || !may_go_on(block)) return false;
    compute(block, orders_[b][std::size_t(task_[b])]);
    for (const int event : seams_->events(block))
      if (event == task_[b]) ++events_[b];
    if (++task_[b] == int(orders_[b].size())) task_[b] = 0, ++pass_[b];
    return true;
  }
  void expect_done(int passes) const {
    for (int row = 0; row < int(state_.size()); ++row)
      if (is_own(row)) {
        EXPECT_EQ(state_[std::size_t(row)], passes * steps_);
      }
  }

private:
  bool is_own(int row) const {
    const int place = division_.order.place(row);
    return place >= division_.cuts.front() && place < division_.cuts.back();
  }
  bool may_go_on(int block) const {
    const auto b = std::size_t(block);
    for (const Seams::Wait& wait : seams_->waits(block))
      if (const int pass = pass_[b] - int(wait.is_for_pass_before);
          wait.task == task_[b] && events_[std::size_t(wait.block)] <
                                       pass * int(seams_->events(wait.block).size()) + wait.event)
        return false;
    return true;
  }
  void expect_output(int block, int output, int row, int value) {
    const int sweep = of_step_.stages == 1 ? output : of_step_.of_stage(output);
    const int owner = seams_->owner(sweep, row, block);
    if (owner != block) {
      EXPECT_NE(seams_->handed_over(owner, output, row), Seams::nowhere);
    }
    EXPECT_EQ((outputs_[{owner, output, row}]), value) << "output " << output << ", row " << row;
  }
  /// A row that a task reads: an output of a block, or the state.
  using Input = std::tuple<int, int, int>; ///< [block, output, row]
  static constexpr int state_output = -1;
  Input input_of(int block, const PassTask& task, int row) const {
    const int stage = of_step_.stage(task.sweep);
    if (stage > 0) return {seams_->owner(of_step_.of_stage(stage - 1), row, block), stage - 1, row};
    const int overwriting = of_step_.of_stage(of_step_.stage_of_pass(task.sweep)),
              owner = of_step_.stages == 1 ? seams_->owner(overwriting, row, block) : block;
    return owner > block ? Input{owner, overwriting, row} : Input{-1, state_output, row};
  }
  void compute(int block, const PassTask& task) {
    const int stage = of_step_.stage(task.sweep), pass = pass_[std::size_t(block)],
              stages = of_step_.stages;
    const int before = pass * steps_ + of_step_.step(task.sweep);
    each_input(lattice_, extra_, task, [&](int row) {
      const Input input = input_of(block, task, row);
      const int output = std::get<1>(input);
      if (output != state_output) {
        expect_output(block, output, row, stage > 0 ? pass : before);
      } else if (is_own(row)) {
        EXPECT_EQ(state_[std::size_t(row)], before) << "row " << row;
      }
      if (of_step_.has_pressure && !of_step_.is_pressure(task.sweep) && !task.is_extra()) {
        EXPECT_EQ(pressures_[input], std::pair(pass, task.sweep - 1)) << "row " << row;
      }
    });
    if (task.work == RowWork::pressure)
      pressures_[input_of(block, task, task.row)] = {pass, int(task.sweep)};
    if (task.work != RowWork::stage) return;
    int& state = state_[std::size_t(task.row)];
    if (is_own(task.row)) {
      EXPECT_EQ(state, before);
    }
    for (const int m : reads_.increments[std::size_t(stage)])
      expect_output(block, m, task.row, pass);
    if (stages == 1) {
      outputs_[{block, task.sweep, task.row}] = state;
      pressures_[{block, task.sweep, task.row}] = pressures_[{-1, state_output, task.row}];
    }
    if (stage + 1 < stages)
      outputs_[{block, stage, task.row}] = pass;
    else
      ++state;
  }

  const Lattice& lattice_;
  const std::vector<LinkedRows>& extra_;
  const StepSweeps of_step_;
  const int steps_; ///< of a pass
  RowDivision division_;
  PassReads reads_;
  std::vector<std::vector<PassTask>> orders_;
  std::optional<Seams> seams_;
  std::vector<int> state_;
  std::map<Input, int> outputs_;
  std::map<Input, std::pair<int, int>> pressures_;
  std::vector<int> pass_, task_, events_; ///< of each block
};

/// Calls check(passes) for methods, blocks and tiles of awkward sizes.
template <class Check>
void each_team(Check&& check) {
  for (const auto& [ny, nz, is_cut] :
       {std::tuple{9, 6, false}, {4, 12, false}, {24, 1, false}, {24, 1, true}}) {
    const Lattice whole = porous_bodies(ny, nz),
                  lattice = is_cut ? cut_into_pieces(whole, {1, 3}) : whole;
    const int rows = int(lattice.rows.size());
    for (const std::vector<LinkedRows>& extra :
         {std::vector<LinkedRows>{}, {{0, rows - 1}, {2, rows / 2}}})
      for (const auto& [stages, steps] : {std::pair{4, 1}, {7, 1}, {2, 1}, {1, 1}, {1, 5}})
        for (const bool has_pressure : {false, true})
          for (const int blocks : {2, 3, 7})
            for (const int tile : {no_tiles, 2})
              for (const bool is_part : {false, true}) {
                // Parts have no extra links, and make one step a pass. Rows that extra links join
                // are whole.
                if (is_part && (!extra.empty() || steps > 1)) continue;
                if (is_cut && !extra.empty()) continue;
                Passes passes(lattice, extra, {stages, has_pressure}, steps, blocks,
                              {tile, is_part});
                check(passes, blocks);
              }
  }
}

TEST(Seams, GiveEachTaskWhatItReadsInAnyInterleaving) {
  constexpr int count = 3;
  std::mt19937 generator(1);
  each_team([&](Passes& passes, int blocks) {
    // Each block in turn goes on for a random number of tasks.
    for (int idle = 0; idle < blocks * 20;) {
      const int block = int(generator() % unsigned(blocks));
      int tasks = 0;
      for (unsigned most = 1 + generator() % 200; unsigned(tasks) < most; ++tasks)
        if (!passes.compute_next(block, count)) break;
      idle = tasks > 0 ? 0 : idle + 1;
    }
    passes.expect_done(count);
  });
}

/// The upper block first: so one thread can compute all blocks.
TEST(Seams, LetOneThreadComputeAllBlocks) {
  each_team([&](Passes& passes, int blocks) {
    for (int pass = 1; pass <= 3; ++pass)
      for (int block = blocks; block-- > 0;)
        while (passes.compute_next(block, pass)) {
        }
    passes.expect_done(3);
  });
}

} // namespace
} // namespace dss
