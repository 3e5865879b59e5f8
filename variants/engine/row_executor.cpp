#include "variants/engine/row_executor.hpp"

#include "variants/api/tried_steps.hpp"
#include "variants/engine/thread_team.hpp"
#include "variants/isa/denormals.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace dss {

/// The members of an ensemble already fill packs. The layers of a part's halo are rows, which
/// cannot be merged. A merged body has no tiles.
static RowForm furthest_form(const Setup& setup) {
  if (setup.ensemble != nullptr || !has_filled_rows(setup.model)) return RowForm::cells;
  const bool may_merge = part_with_neighbours(setup.part) == nullptr && setup.tile == 0;
  return may_merge ? RowForm::merged : RowForm::filled;
}

template <class T>
static LaneKind lane_kind(const PackedRow<T>& row) {
  return row.members != nullptr ? LaneKind::members
         : row.maps != nullptr  ? LaneKind::filled
                                : LaneKind::neighbours;
}

/// Why the wavefront does not serve, whatever the rows are; empty if it may.
static std::string_view why_never_in_blocks(const Setup& setup, const PartSetup* part) {
  if (setup.method.has_error_stage) return "adaptive steps";
  if (part != nullptr && part->is_every_stage) return "halos are exchanged in between";
  return "";
}

template <class T>
auto RowExecutor<T>::make_rows(const Setup& setup) -> Rows {
  const PartSetup* const part = part_with_neighbours(setup.part);
  const auto packed = [&](Lattice cut) {
    return std::make_unique<PackedRows<T>>(setup.problem, setup.model,
                                           part == nullptr ? nullptr : &part->part, Memory::heap(),
                                           setup.ensemble, furthest_form(setup), std::move(cut));
  };
  Rows whole{packed({})};
  if (!why_never_in_blocks(setup, part).empty() || !setup.problem.extra_links.empty()) return whole;
  const RowStorage storage(*whole.packed, setup.method, setup.precision);
  RowCuts cuts = choose_cuts(*whole.packed, setup.method, storage, setup.tile);
  if (cuts.at.empty()) return whole;
  return {packed(cut_into_pieces(setup.problem.lattice, std::move(cuts.at))), cuts.pieces};
}

template <class T>
RowExecutor<T>::RowExecutor(const Setup& setup)
    : setup_(setup), part_(part_with_neighbours(setup.part)), made_(make_rows(setup)),
      rows_(packed_, setup_.method, setup_.precision, setup_.steps(),
            [this](int r) { return row(r); }) {
  for (PackedRow<T>& row : packed_.rows)
    row.kernels = &find_kernels<T>(setup.model, row.shape.terms, lane_kind(row));
  why_staged_ = why_staged();
  const bool is_staged = !why_staged_.empty();
  if (is_staged && packed_.is_ensemble())
    throw std::logic_error("an ensemble is not computed stage by stage");
  if (is_staged) refuse_tile(setup_, "it is computed stage by stage");
  if (!setup_.problem.extra_links.empty()) refuse_tile(setup_, "extra links join its rows");
  if (is_staged)
    staged_.emplace(packed_, setup_.method, setup_.dt, rows_.storage(), setup_.threads, part_);
  else
    make_blocks();
}

template <class T>
std::string_view RowExecutor<T>::why_staged() {
  const std::string_view why = why_never_in_blocks(setup_, part_);
  if (!why.empty() || setup_.problem.extra_links.empty()) return why;
  if (is_part()) return "extra links may join rows of several parts";
  if (setup_.threads == 1) return "";
  // Else sweeps would differ by more than a block, so that threads would compute in turn.
  const ExtraLinks<T> extra_links(packed_);
  const long halo = divide_rows(packed_, extra_links.rows(), setup_.threads).halo;
  if (sweeps_.count() * halo * setup_.threads > long(packed_.rows.size()))
    return "extra links join distant rows of several threads";
  return "";
}

template <class T>
void RowExecutor<T>::make_blocks() {
  const Method& method = setup_.method;
  const int rows = int(packed_.rows.size());
  const ExtraLinks<T> extra_links(packed_);
  division_ = divide_rows(packed_, extra_links.rows(), setup_.threads);
  shape_.steps = steps_a_pass(packed_, method, std::min(setup_.threads, rows), division_.halo);
  const int sweeps = shape_.steps * sweeps_.count();
  cut_evenly(division_, packed_, setup_.threads, sweeps);
  threads_ = division_.blocks();
  // The rows that the upper neighbours wait for are the last ones of a block that is computed
  // first.
  const int halo = sweeps_.count() * division_.halo, edge = packed_.own_end - halo;
  if (is_part() && part_->is_overlapped && threads_ == 1 && packed_.own_end < rows &&
      edge - packed_.own_begin >= 3 * halo)
    division_.cuts = {packed_.own_begin, edge + division_.halo - halo, packed_.own_end};
  blocks_.make(packed_, division_, stored_fields(), sweeps);
  shape_.form.is_in_row_order = is_part();
  const int across =
      most_rows_across(packed_.lattice, division_, shape_.form.is_in_row_order, extra_links.rows());

  shape_.form.tile = packed_.is_cut() ? made_.tile
                                      : choose_tile(packed_, method, rows_.storage(), shape_.steps,
                                                    across, setup_.tile);
  wavefront_.emplace(packed_, method, setup_.steps(), rows_.storage(), signal_count(setup_.problem),
                     blocks_, shape_, extra_links);
}

template <class T>
T* RowExecutor<T>::row(int r) {
  return staged_ ? staged_->row(r) : blocks_.row(r, parity_);
}

template <class T>
std::pair<T*, T*> RowExecutor<T>::copy_row(int copy, int r) {
  if (staged_) return {staged_->copy_row(copy, r), nullptr};
  return blocks_.copy_row(copy, r);
}

template <class T>
HaloLayout RowExecutor<T>::halo_layout(std::span<const std::size_t> elements, int copy) {
  bool is_stable = true;
  const auto is_own = [&](std::size_t element) { return part_->part.layer[element] == 0; };
  HaloLayout layout = rows_.layout(
      elements, [&](int r) { return copy_row(copy, r); }, is_own);
  for (const std::size_t element : elements) {
    const int r = int(place_of(packed_, element).row);
    const bool own = is_own(element), is_halo_row = !packed_.is_computed(r, 0);
    if (staged_) // a staged part writes own rows whole, including the halo elements among them
      is_stable &= staged_->copies() > 1 && (own || is_halo_row);
    else
      is_stable &= own ? copy_row(copy, r).second != nullptr : blocks_.of(r).is_remote();
  }
  layout.is_stable = is_stable;
  return layout;
}

template <class T>
void RowExecutor<T>::refresh_halo() {
  if (!is_part()) return;
  exchange(&Halo::send, current_copy());
  exchange(&Halo::receive, current_copy());
}

template <class T>
void RowExecutor<T>::write(std::size_t first, std::span<const double> fields) {
  stop_leapfrog();
  revive_members();
  parity_ = 0;
  rows_.write(first, fields);
  blocks_.publish_all(parity_);
}

template <class T>
void RowExecutor<T>::read(std::size_t first, std::span<double> fields) {
  if (is_started_ && end_rates_.empty()) end_rates_ = all_rates(end_signals_);
  rows_.read(first, fields, is_started_ ? end_rates_.data() : nullptr);
}

template <class T>
void RowExecutor<T>::save(std::size_t first, std::span<double> kept) {
  rows_.save(first, kept, is_started_);
}

template <class T>
void RowExecutor<T>::restore(std::size_t first, std::span<const double> kept) {
  end_rates_ = {};
  revive_members();
  is_started_ = rows_.restore(first, kept);
  blocks_.publish_all(parity_);
}

// A row's input is its own fields and those of its upper rows, so copies of the next `reach` rows
// are enough; with pressures, which have the same inputs, as many more.
template <class T>
template <class Rates, class Done>
void RowExecutor<T>::evaluate(std::span<const double> signals, Rates&& rates, Done&& done) {
  refresh_halo();
  const int rows = int(packed_.rows.size()), reach = packed_.reach;
  const int kept = sweeps_.a_stage() * reach + 1;
  const std::size_t row_size =
      std::size_t(packed_.max_packs + 1) * std::size_t(rows_.plain_fields() * W);
  Buffer<T> plain(std::size_t(kept) * row_size), zero(row_size), ones(std::size_t{W});
  const auto plain_row = [&](int r) { return plain.data() + std::size_t(r % kept) * row_size; };
  ExtraLinks<T> extra_links(packed_);
  {
    const FlushDenormals guard;
    extra_links.evaluate([this](int r) { return row(r); }, stored_fields());
  }
  StepSignals<T> values(signal_count(setup_.problem), 1, packed_.members().size());
  std::fill_n(ones.data(), W, T(1));
  values.set(signals.data(), 1);
  CarryRings<T> carry(packed_), strains(packed_);
  for (int r = 0, copied = 0, pressed = 0; r < rows; ++r) {
    for (; copied < std::min(rows, r + kept); ++copied)
      rows_.copy_plain_row(copied, row(copied), plain_row(copied));
    for (; sweeps_.has_pressure && pressed < std::min(rows, r + reach + 1); ++pressed) {
      RowTask<T> task;
      set_row(task, packed_, pressed, rows_.plain_fields(), strains, plain_row);
      task.signals = values.stage(0);
      task.out = plain_row(pressed);
      const FlushDenormals guard;
      find_pressures(*packed_.rows[std::size_t(pressed)].kernels, task);
    }
    RowTask<T> task;
    set_row(task, packed_, r, rows_.plain_fields(), carry, plain_row);
    task.signals = values.stage(0);
    task.base = zero.data(); // out = 0 + 1 f
    task.out = rates(r);
    task.beta = 1;
    task.betas = ones.data();
    {
      const FlushDenormals guard;
      packed_.rows[std::size_t(r)].kernels->stage(task);
    }
    done(r);
  }
}

template <class T>
Buffer<T> RowExecutor<T>::all_rates(std::span<const double> signals) {
  Buffer<T> rates(rows_.plain_size());
  evaluate(
      signals, [&](int r) { return rates.data() + rows_.plain_offset(r); }, [](int) {});
  return rates;
}

template <class T>
void RowExecutor<T>::derivative(std::span<const double> signals, std::span<double> rates) {
  stop_leapfrog();
  rows_.rates_out(all_rates(signals).data(), rates);
}

template <class T>
void RowExecutor<T>::stop_leapfrog() {
  if (!is_started_) return;
  std::vector<double> state(packed_.lattice.element_count * field_count);
  read(0, state);
  is_started_ = false;
  end_rates_ = {};
  write(0, state);
}

template <class T>
void RowExecutor<T>::start_leapfrog(std::span<const double> signals) {
  Buffer<T> rates(std::size_t(packed_.max_packs) * std::size_t(rows_.plain_fields() * W));
  evaluate(
      signals, [&](int) { return rates.data(); }, [&](int r) { rows_.start_row(r, rates.data()); });
  blocks_.publish_all(parity_);
}

template <class T>
Outcome RowExecutor<T>::advance(long steps, std::span<const double> signals) {
  if (steps <= 0) return {};
  if (setup_.method.has_error_stage) return advance_by_tries(*this, setup_, steps, signals);
  const std::size_t width = signal_width();
  if (rows_.is_staggered() && !is_started_)
    start_leapfrog(signals.first(width)), is_started_ = true;
  end_rates_ = {};
  end_signals_.assign(signals.end() - std::ptrdiff_t(width), signals.end());
  return staged_ ? run_staged(steps, signals) : run_blocks(steps, signals);
}

// After a failure a part continues, because its neighbours wait for it. They soon fail too, and all
// parts learn of it at the end.
template <class T>
Outcome RowExecutor<T>::run_blocks(long steps, std::span<const double> signals) {
  const std::size_t step_width = signal_width() * std::size_t(setup_.method.stages);
  const long at_once = shape_.steps, passes = (steps + at_once - 1) / at_once;
  std::vector<Block<T>>& blocks = blocks_.all();
  const std::size_t first_own = blocks_.first_own(), count = wavefront_->steps().size();
  const bool is_overlapped = is_part() && part_->is_overlapped && threads_ == 1;
  std::vector<FirstFailure> failures(packed_.members().size());
  if (is_part()) exchange(&Halo::send, parity_);
  wavefront_->start(is_crowded(threads_));
  const auto work = [&](int thread, auto&& synchronise) {
    const FlushDenormals guard;
    for (long pass = 0; pass < passes; ++pass) {
      const long n = pass * at_once;
      const double* const values = &signals[std::size_t(n) * step_width];
      const int parity = (parity_ + int(pass & 1)) & 1;
      const bool is_last = pass + 1 == passes;
      for (std::size_t b = std::size_t(thread); b < count; b += std::size_t(threads_))
        std::ranges::fill(blocks[first_own + b].failures, typename Block<T>::Failure{});
      if (is_overlapped) {
        step_overlapped(values, pass, parity, is_last);
      } else {
        if (is_part() && thread == 0) exchange(&Halo::receive, parity);
        if (is_part()) synchronise();
        wavefront_->pass(thread, values, int(std::min(at_once, steps - n)), parity, pass);
      }
      for (std::size_t b = std::size_t(thread); b < count; b += std::size_t(threads_))
        for (std::size_t m = 0; m < failures.size(); ++m)
          if (const auto& failed = blocks[first_own + b].failures[m]; failed.step >= 0)
            failures[m].meet(n + failed.step, failed.element);
      if (threads_ == 1) leave_out(failures); // others would read the lanes meanwhile
      if (is_part()) synchronise();
      if (!is_part() && have_all_failed(failures, n + at_once))
        break; // a faster thread may already have failed in the next pass
      if (is_part() && !is_overlapped && !is_last && thread == 0) exchange(&Halo::send, parity ^ 1);
    }
    if (!is_part()) wavefront_->leave(thread);
  };
  run_team(threads_, work);
  parity_ = (parity_ + int(passes & 1)) & 1;
  return outcome_of(failures, steps);
}

template <class T>
bool RowExecutor<T>::have_all_failed(const std::vector<FirstFailure>& failures, long before) const {
  for (std::size_t m = 0; m < failures.size(); ++m)
    if (packed_.is_live(int(m)) && !(failures[m].is_met() && failures[m].step() < before))
      return false;
  return true;
}

template <class T>
Outcome RowExecutor<T>::outcome_of(const std::vector<FirstFailure>& failures, long steps) {
  if (!packed_.is_ensemble()) return failures.front().outcome(steps);
  const bool is_over = have_all_failed(failures, steps);
  for (std::size_t m = 0; m < failures.size(); ++m) {
    if (!outcomes_[m].is_finite) continue; // it failed earlier
    outcomes_[m] = failures[m].outcome(steps);
    outcomes_[m].element /= failures.size();
  }
  leave_out(failures);
  return is_over ? outcomes_.front() : Outcome{true, steps, 0};
}

template <class T>
void RowExecutor<T>::leave_out(const std::vector<FirstFailure>& failures) {
  for (std::size_t m = 0; m < failures.size() && packed_.is_ensemble(); ++m)
    if (failures[m].is_met()) packed_.live_lanes &= simd::LaneMask(~(1u << m));
}

template <class T>
void RowExecutor<T>::revive_members() {
  packed_.live_lanes = packed_.all_lanes;
  if (packed_.is_ensemble()) outcomes_.assign(packed_.members().size(), Outcome{});
}

template <class T>
void RowExecutor<T>::step_overlapped(const double* signals, long pass, int parity, bool is_last) {
  const bool is_split = wavefront_->steps().size() == 2;
  const int edge =
      std::min(packed_.own_begin + sweeps_.count() * packed_.reach, packed_.own_end) - 1;
  overlapped_step(
      part_->halo, parity, parity ^ 1, is_last, is_split,
      [&] { wavefront_->pass(1, signals, 1, parity, pass); },
      [&](auto&& edge_is_done) {
        wavefront_->step(0).watch(edge, edge_is_done);
        wavefront_->pass(0, signals, 1, parity, pass);
      });
}

template <class T>
Outcome RowExecutor<T>::run_staged(long steps, std::span<const double> signals) {
  const std::size_t width = signal_width(), step_width = width * std::size_t(setup_.method.stages);
  staged_->forget_failures();
  FirstFailure failure;
  if (is_part()) exchange(&Halo::send, current_copy());
  const auto work = [&](int thread, auto&& synchronise) {
    const FlushDenormals guard;
    StepSignals<T> values(width, setup_.method.stages);
    for (long n = 0; n < steps; ++n) {
      values.set(&signals[std::size_t(n) * step_width], setup_.method.stages);
      staged_->step(thread, values, n + 1 == steps, synchronise);
      const std::optional<std::size_t> failed = staged_->failed_element();
      if (failed && thread == 0 && !failure.is_met()) failure.meet(n, *failed);
      if (failed && !is_part()) break;
      synchronise(); // no thread starts the next step, and fails in it, before all have looked
    }
  };
  run_team(staged_->threads(), work);
  return failure.outcome(steps);
}

template <class T>
std::string RowExecutor<T>::schedule() const {
  const std::string_view rows = packed_.filled.is_any() ? ", filled packs" : "";
  if (staged_) return fmt::format("stage by stage: {}{}{}", why_staged_, rows, sweeps_.text());
  return fmt::format(
      "wavefront over rows, reach {}, in place{}{}{}{}{}", packed_.is_cut() ? 1 : packed_.reach,
      shape_.steps > 1 ? fmt::format(", {} steps a pass", shape_.steps) : "",
      packed_.is_cut() ? fmt::format(", tiles of {} elements",
                                     packed_.cut.cuts[std::size_t(shape_.form.tile) - 1] -
                                         packed_.lattice.rows.front().x_begin)
                       : tiles_text(shape_.form.tile),
      rows, setup_.problem.extra_links.empty() ? "" : ", with extra links", sweeps_.text());
}

template <class T>
std::size_t RowExecutor<T>::bytes() const {
  std::size_t sum = packed_.bytes();
  for (const Block<T>& block : blocks_.all()) sum += block.bytes();
  if (wavefront_) sum += wavefront_->bytes();
  return staged_ ? sum + staged_->bytes() : sum;
}

std::unique_ptr<Executor> create_row_executor(const Setup& setup) {
  if (setup.method.stages == 0 || setup.method.has_leaps()) // make_executor has others for them
    throw std::logic_error(fmt::format("{} is not a table of stages", setup.method.name));
  if (is_single(setup.precision)) return std::make_unique<RowExecutor<float>>(setup);
  return std::make_unique<RowExecutor<double>>(setup);
}

} // namespace dss
