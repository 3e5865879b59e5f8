#pragma once
/// Stage by stage: the fallback for scenes whose extra links break the order of rows. Every stage keeps all rows;
/// threads meet twice a stage.
#include "variants/engine/wavefront.hpp"

#include <algorithm>

namespace dss {

/// Links outside the grid: evaluated one by one, always in the same order, into the wrench rows that the row kernels
/// add.
template <class T>
class ExtraLinks {
public:
  ExtraLinks(const Problem& problem, PackedRows<T>& packed);
  bool empty() const { return links_.empty(); }
  /// `row(r)` is the address of row r, with `fields` fields a pack.
  template <class RowAddress>
  void evaluate(RowAddress&& row, int fields);

private:
  struct Link {
    ExtraLinkConstants<T> constants;
    Place i, j;
  };
  T* lane(T* row, const Place& place, int components) const {
    return row + std::ptrdiff_t(place.pack) * components * PackedRows<T>::W + place.lane;
  }
  PackedRows<T>& packed_;
  std::vector<Link> links_;
};

/// All rows of the state and of every intermediate stage.
template <class T>
class StagedRows {
public:
  StagedRows(PackedRows<T>& packed, const Problem& problem, const Method& method, double dt, int fields, int threads);
  T* row(int r) { return stage_row(0, r); }
  /// One step by the calling thread of a team of `threads`; all call it together. Synchronise() is the team's barrier.
  template <class Synchronise>
  void step(int thread, const StepSignals<T>& signals, Synchronise&& synchronise);
  int failed_row() const;
  void forget_failures() { std::fill(failed_rows_.begin(), failed_rows_.end(), -1); }
  std::size_t bytes() const;
  int threads() const { return int(cuts_.size()) - 1; }

private:
  T* stage_row(int stage, int r) {
    return stages_[std::size_t(stage)].data() + packed_.rows[std::size_t(r)].pack_offset * pack_size_;
  }
  PackedRows<T>& packed_;
  const Method& method_;
  const int fields_;
  const std::size_t pack_size_;
  std::vector<int> cuts_;
  std::vector<Buffer<T>>
      stages_; ///< [0] the state, [m] the output of stage m - 1; one-stage methods: [1] the next state
  std::vector<CarryRings<T>> carry_;
  std::vector<int> failed_rows_;
  const std::vector<StageUpdate<T>> updates_;
  ExtraLinks<T> extra_links_;
};

template <class T>
ExtraLinks<T>::ExtraLinks(const Problem& problem, PackedRows<T>& packed) : packed_(packed) {
  for (const ExtraLink& link : problem.extra_links)
    links_.push_back({extra_link_constants<T>(problem, link), place_of(packed, link.i), place_of(packed, link.j)});
}

template <class T>
template <class RowAddress>
void ExtraLinks<T>::evaluate(RowAddress&& row, int fields) {
  constexpr int W = PackedRows<T>::W, most = field_count;
  const int components = int(packed_.layout.wrench.size());
  for (const Link& link : links_)
    for (const Place* place : {&link.i, &link.j}) {
      T* wrench = lane(packed_.extra_wrench(place->row), *place, components);
      for (int c = 0; c < components; ++c) wrench[c * W] = 0;
    }
  for (const Link& link : links_) {
    T state[2][most], wrench[2][6];
    const Place* places[] = {&link.i, &link.j};
    T* targets[2];
    for (std::size_t e = 0; e < 2; ++e) {
      const T* fields_of = lane(row(int(places[e]->row)), *places[e], fields);
      targets[e] = lane(packed_.extra_wrench(places[e]->row), *places[e], components);
      for (int f = 0; f < packed_.fields(); ++f) state[e][f] = fields_of[f * W];
      for (int c = 0; c < components; ++c) wrench[e][c] = targets[e][c * W];
    }
    packed_.rows[link.i.row].kernels->extra_link(link.constants, state[0], state[1], wrench[0], wrench[1]);
    for (std::size_t e = 0; e < 2; ++e)
      for (int c = 0; c < components; ++c) targets[e][c * W] = wrench[e][c];
  }
}

template <class T>
template <class Synchronise>
void StagedRows<T>::step(int thread, const StepSignals<T>& signals, Synchronise&& synchronise) {
  const bool is_leapfrog = method_.family == Method::Family::leapfrog, is_swapped = method_.stages == 1;
  CarryRings<T>& carry = carry_[std::size_t(thread)];
  for (int s = 0; s < method_.stages; ++s) {
    const auto input = [&](int r) -> T* { return stage_row(s, r); };
    if (thread == 0) extra_links_.evaluate(input, fields_);
    synchronise();
    const bool is_last = s + 1 == method_.stages;
    const int begin = cuts_[std::size_t(thread)], end = cuts_[std::size_t(thread) + 1];
    if (begin > 0) prime_links(packed_, begin, fields_, carry, input);
    for (int r = begin; r < end; ++r) {
      RowTask<T> task;
      set_row(task, packed_, r, fields_, carry, input);
      task.signals = signals.stage(s);
      T* const out = is_swapped ? stage_row(1, r) : is_last ? stage_row(0, r) : stage_row(s + 1, r);
      updates_[std::size_t(s)].set(task, stage_row(0, r), out, [&](int m) { return stage_row(m + 1, r); });
      const KernelSet<T>& kernels = *packed_.rows[std::size_t(r)].kernels;
      const bool is_finite = is_leapfrog ? kernels.leapfrog(task) : kernels.stage(task);
      if (!is_finite && is_last && failed_rows_[std::size_t(thread)] < 0) failed_rows_[std::size_t(thread)] = r;
    }
    synchronise();
  }
  if (is_swapped) { // one stage reads neighbours while it writes
    if (thread == 0) std::swap(stages_[0], stages_[1]);
    synchronise();
  }
}

} // namespace dss
