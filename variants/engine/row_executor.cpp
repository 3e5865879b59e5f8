#include "variants/engine/row_executor.hpp"

#include "solver/error.hpp"
#include "solver/numerics/denormals.hpp"
#include "variants/engine/barrier.hpp"

#include <algorithm>
#include <cmath>
#include <omp.h>

namespace dss {

/// Runs work(thread, synchronise) on a team of exactly `threads` threads; with fewer, blocks of rows would silently stay behind.
/// @throws InputError if OpenMP grants fewer
template <class Work>
static void run_team(int threads, Work&& work) {
  if (threads == 1) {
    work(0, [] {});
    return;
  }
  int granted = threads;
  Barrier barrier(threads);
  omp_set_dynamic(0);
#pragma omp parallel num_threads(threads)
  {
    if (omp_get_num_threads() == threads) {
      work(omp_get_thread_num(), [&] { barrier.arrive_and_wait(); });
    } else {
#pragma omp single
      granted = omp_get_num_threads();
    }
  }
  if (granted != threads)
    throw InputError("--threads " + std::to_string(threads) + ": OpenMP grants only " + std::to_string(granted) +
                     " (OMP_THREAD_LIMIT?); give at most that");
}

template <class T>
RowExecutor<T>::RowExecutor(const Setup& setup) : setup_(setup), packed_(setup.problem, setup.model) {
  const Method& method = setup_.method;
  if (!setup_.problem.extra_links.empty()) {
    staged_.emplace(packed_, setup_.problem, method, setup_.dt, stored_fields(), setup_.threads);
    return;
  }
  const std::vector<int> cuts = cut_rows(packed_, setup_.threads);
  for (std::size_t b = 0; b + 1 < cuts.size(); ++b)
    blocks_.emplace_back(packed_, cuts[b], cuts[b + 1], stored_fields(), method.stages * packed_.reach, !is_leapfrog(),
                         WavefrontStep<T>::sweeps(packed_, method, cuts.size() - 1));
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    steps_.emplace_back(packed_, method, setup_.dt, stored_fields(), signal_count(setup_.problem), blocks_, b);
}

template <class T>
T* RowExecutor<T>::row(int r) {
  if (staged_) return staged_->row(r);
  for (Block<T>& block : blocks_)
    if (block.owns(r)) return block.row(r);
  return nullptr;
}

template <class T>
template <class Visit>
void RowExecutor<T>::each_element(std::size_t first, std::size_t count, Visit&& visit) {
  if (count == 0) return;
  for (std::size_t r = row_of(packed_.lattice, first); r < packed_.rows.size(); ++r) {
    const Row& lattice_row = packed_.lattice.rows[r];
    if (lattice_row.first_element >= first + count) break;
    T* const packs = row(int(r));
    each_cell(packed_.lattice, lattice_row, [&](std::size_t element, int x) {
      if (element < first || element >= first + count) return;
      visit(element, packs + std::ptrdiff_t(x / W - packed_.rows[r].first_pack) * stored_fields() * W + x % W);
    });
  }
}

template <class T>
template <class Visit>
void RowExecutor<T>::each_velocity(Visit&& visit) const {
  int half = packed_.fields();
  for (int f = 0; f < packed_.fields(); ++f) {
    const Field field = packed_.layout.fields[std::size_t(f)];
    if ((field >= vx && field <= vz) || field >= wx) visit(f, is_predicted() ? half++ : f);
  }
}

template <class T>
void RowExecutor<T>::write(std::size_t first, std::span<const double> fields) {
  stop_leapfrog();
  parity_ = 0;
  each_element(first, fields.size() / field_count, [&](std::size_t element, T* lane) {
    const double* from = &fields[(element - first) * field_count];
    for (int f = 0; f < packed_.fields(); ++f) lane[f * W] = T(from[packed_.layout.fields[std::size_t(f)]]);
  });
  for (Block<T>& block : blocks_)
    for (int r = block.begin; r < block.end; ++r)
      if (block.is_published(r)) block.publish(r, parity_);
}

template <class T>
void RowExecutor<T>::read(std::size_t first, std::span<double> fields) {
  if (is_started_ && end_rates_.empty()) end_rates_ = evaluate(end_signals_);
  std::fill(fields.begin(), fields.end(), 0.0);
  each_element(first, fields.size() / field_count, [&](std::size_t element, T* lane) {
    const std::span<double> out = fields.subspan((element - first) * field_count, field_count);
    for (int f = 0; f < packed_.fields(); ++f)
      out[std::size_t(packed_.layout.fields[std::size_t(f)])] = double(lane[f * W]);
    if (is_started_) read_synchronised(element, lane, out);
  });
}

/// v_n = v_{n-1/2} + (h / 2) a(x_n, p_n)
template <class T>
void RowExecutor<T>::read_synchronised(std::size_t element, const T* lane, std::span<double> out) {
  const Place place = place_of(packed_, element);
  const std::size_t pack = packed_.rows[place.row].pack_offset + std::size_t(place.pack);
  const T* rates = end_rates_.data() + pack * std::size_t(packed_.fields() * W) + place.lane;
  each_velocity([&](int f, int half) {
    out[std::size_t(packed_.layout.fields[std::size_t(f)])] =
        double(simd::fma(T(setup_.dt / 2), rates[f * W], lane[half * W]));
  });
}

template <class T>
Buffer<T> RowExecutor<T>::evaluate(std::span<const double> signals) {
  const FlushDenormals guard;
  const std::size_t pack_size = std::size_t(packed_.fields() * W), stored_size = std::size_t(stored_fields() * W);
  const std::size_t packs = packed_.rows.back().pack_offset + std::size_t(packed_.rows.back().packs) + 1;
  Buffer<T> plain(packs * pack_size), rates(packs * pack_size), zero(std::size_t(packed_.max_packs) * pack_size);
  const auto plain_row = [&](int r) { return plain.data() + packed_.rows[std::size_t(r)].pack_offset * pack_size; };
  for (int r = 0; r < int(packed_.rows.size()); ++r)
    for (int p = 0; p < packed_.rows[std::size_t(r)].packs; ++p)
      std::copy_n(row(r) + std::size_t(p) * stored_size, pack_size, plain_row(r) + std::size_t(p) * pack_size);
  ExtraLinks<T> extra_links(setup_.problem, packed_);
  extra_links.evaluate(plain_row, packed_.fields());
  StepSignals<T> values(signals.size(), 1);
  values.set(signals.data(), 1);
  CarryRings<T> carry(packed_);
  for (int r = 0; r < int(packed_.rows.size()); ++r) {
    RowTask<T> task;
    set_row(task, packed_, r, packed_.fields(), carry, plain_row);
    task.signals = values.stage(0);
    task.base = zero.data(); // out = 0 + 1 f
    task.out = rates.data() + packed_.rows[std::size_t(r)].pack_offset * pack_size;
    task.beta = 1;
    packed_.rows[std::size_t(r)].kernels->stage(task);
  }
  return rates;
}

template <class T>
void RowExecutor<T>::derivative(std::span<const double> signals, std::span<double> rates) {
  stop_leapfrog();
  const Buffer<T> values = evaluate(signals);
  std::fill(rates.begin(), rates.end(), 0.0);
  for (std::size_t r = 0; r < packed_.rows.size(); ++r)
    each_cell(packed_.lattice, packed_.lattice.rows[r], [&](std::size_t element, int x) {
      const std::size_t pack = packed_.rows[r].pack_offset + std::size_t(x / W - packed_.rows[r].first_pack);
      const T* lane = values.data() + pack * std::size_t(packed_.fields() * W) + x % W;
      for (int f = 0; f < packed_.fields(); ++f)
        rates[element * field_count + std::size_t(packed_.layout.fields[std::size_t(f)])] = double(lane[f * W]);
    });
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

/// v_{-1/2} = v_0 - (h / 2) a_0, and p_0 = v_0, which the rows hold already.
template <class T>
void RowExecutor<T>::start_leapfrog(std::span<const double> signals) {
  const Buffer<T> rates = evaluate(signals);
  for (int r = 0; r < int(packed_.rows.size()); ++r)
    for (int p = 0; p < packed_.rows[std::size_t(r)].packs; ++p)
      for (int l = 0; l < W; ++l) {
        T* lane = row(r) + std::ptrdiff_t(p) * stored_fields() * W + l;
        const std::size_t pack = packed_.rows[std::size_t(r)].pack_offset + std::size_t(p);
        const T* rate = rates.data() + pack * std::size_t(packed_.fields() * W) + l;
        each_velocity(
            [&](int f, int half) { lane[half * W] = simd::fma(T(-setup_.dt / 2), rate[f * W], lane[f * W]); });
      }
  for (Block<T>& block : blocks_)
    for (int r = block.begin; r < block.end; ++r)
      if (block.is_published(r)) block.publish(r, parity_);
}

template <class T>
Outcome RowExecutor<T>::advance(long steps, std::span<const double> signals) {
  if (steps <= 0) return {};
  const std::size_t width = signal_count(setup_.problem);
  if (is_leapfrog() && !is_started_) start_leapfrog(signals.first(width)), is_started_ = true;
  end_rates_ = {};
  end_signals_.assign(signals.end() - std::ptrdiff_t(width), signals.end());
  return staged_ ? run_staged(steps, signals) : run_blocks(steps, signals);
}

template <class T>
Outcome RowExecutor<T>::run_blocks(long steps, std::span<const double> signals) {
  const std::size_t width = signal_count(setup_.problem), step_width = width * std::size_t(setup_.method.stages);
  const int threads = int(blocks_.size());
  const long at_once = WavefrontStep<T>::steps_a_pass(packed_, setup_.method, blocks_.size());
  std::atomic<long> failed_step{-1};
  const auto work = [&](int thread, auto&& synchronise) {
    const FlushDenormals guard;
    Block<T>& block = blocks_[std::size_t(thread)];
    WavefrontStep<T>& step = steps_[std::size_t(thread)];
    block.failed_row = -1;
    for (long pass = 0, n = 0; n < steps; ++pass, n += at_once) {
      step(&signals[std::size_t(n) * step_width], int(std::min(at_once, steps - n)), (parity_ + int(pass & 1)) & 1);
      if (block.failed_row >= 0) failed_step = n + block.failed_step;
      synchronise();
      if (failed_step >= 0 && failed_step < n + at_once)
        break; // a faster thread may already have failed in the next pass
    }
  };
  run_team(threads, work);
  parity_ = (parity_ + int(steps & 1)) & 1; // passes of several steps publish nothing
  for (const Block<T>& block : blocks_)
    if (block.failed_row >= 0) return {false, failed_step, first_failed_element(block.failed_row)};
  return {true, steps, 0};
}

template <class T>
Outcome RowExecutor<T>::run_staged(long steps, std::span<const double> signals) {
  const std::size_t width = signal_count(setup_.problem), step_width = width * std::size_t(setup_.method.stages);
  const int threads = staged_->threads();
  staged_->forget_failures();
  long failed_step = -1;
  const auto work = [&](int thread, auto&& synchronise) {
    const FlushDenormals guard;
    StepSignals<T> values(width, setup_.method.stages);
    for (long n = 0; n < steps; ++n) {
      values.set(&signals[std::size_t(n) * step_width], setup_.method.stages);
      staged_->step(thread, values, synchronise);
      if (staged_->failed_row() >= 0) {
        if (thread == 0) failed_step = n;
        break;
      }
      synchronise(); // nobody starts the next step, and fails in it, before all have looked
    }
  };
  run_team(threads, work);
  if (failed_step >= 0) return {false, failed_step, first_failed_element(staged_->failed_row())};
  return {true, steps, 0};
}

template <class T>
std::size_t RowExecutor<T>::first_failed_element(int r) {
  std::size_t failed = packed_.lattice.rows[std::size_t(r)].first_element;
  bool is_found = false;
  const Row& lattice_row = packed_.lattice.rows[std::size_t(r)];
  each_cell(packed_.lattice, lattice_row, [&](std::size_t element, int x) {
    const T* lane =
        row(r) + std::ptrdiff_t(x / W - packed_.rows[std::size_t(r)].first_pack) * stored_fields() * W + x % W;
    for (int f = 0; f < packed_.fields() && !is_found; ++f)
      if (!std::isfinite(lane[f * W])) failed = element, is_found = true;
  });
  return failed;
}

template <class T>
std::string RowExecutor<T>::schedule() const {
  if (staged_) return "stage by stage: extra links break the order of rows";
  return "wavefront over rows, reach " + std::to_string(packed_.reach) + ", in place";
}

template <class T>
std::size_t RowExecutor<T>::bytes() const {
  std::size_t sum = packed_.bytes();
  for (const Block<T>& block : blocks_) sum += block.bytes();
  for (const WavefrontStep<T>& step : steps_) sum += step.bytes();
  return staged_ ? sum + staged_->bytes() : sum;
}

std::unique_ptr<Executor> create_row_executor(const Setup& setup) {
  if (setup.precision == Precision::f32) return std::make_unique<RowExecutor<float>>(setup);
  return std::make_unique<RowExecutor<double>>(setup);
}

} // namespace dss
