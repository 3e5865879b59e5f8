#include "variants/opencl/rhs_executor.hpp"

#include "kernels/physics.hpp"
#include "solver/numerics/denormals.hpp"
#include "variants/engine/packs.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss::opencl {

template <class T, int W>
RhsExecutor<T, W>::RhsExecutor(const Setup& setup, const Device& device, const Layout& layout)
    : setup_(setup), rates_(setup.problem, setup.model, nullptr, device, layout, false),
      rows_(packed_, setup_.method, setup_.dt, [this](int r) { return row(r); }),
      updates_(stage_updates<T>(setup_.method, setup_.dt)) {
  state_ = dss::Buffer<T>(packed_.readable_packs() * std::size_t(rows_.stored_fields() * W));
  plain_ = dss::Buffer<T>(rates_.size());
  sums_ = dss::Buffer<T>(rates_.size());
  for (int s = 0; s + 1 < setup_.method.stages; ++s) stages_.emplace_back(rates_.size());
}

template <class T, int W>
T* RhsExecutor<T, W>::row(int r) {
  return state_.data() + packed_.rows[std::size_t(r)].pack_offset * std::size_t(rows_.stored_fields() * W);
}

template <class T, int W>
void RhsExecutor<T, W>::write(std::size_t first, std::span<const double> fields) {
  stop_leapfrog();
  rows_.write(first, fields);
}

template <class T, int W>
void RhsExecutor<T, W>::read(std::size_t first, std::span<double> fields) {
  if (is_started_ && end_rates_.empty()) end_rates_ = scaled_rates(end_signals_);
  rows_.read(first, fields, is_started_ ? end_rates_.data() : nullptr);
}

template <class T, int W>
void RhsExecutor<T, W>::derivative(std::span<const double> signals, std::span<double> rates) {
  stop_leapfrog();
  rows_.rates_out(scaled_rates(signals).data(), rates);
}

template <class T, int W>
void RhsExecutor<T, W>::stop_leapfrog() {
  if (!is_started_) return;
  std::vector<double> state(packed_.lattice.element_count * field_count);
  read(0, state);
  is_started_ = false;
  end_rates_.clear();
  rows_.write(0, state);
}

/// Factors from the sums that the device leaves to the rates of the fields, and how many fields each has.
template <class T>
struct RateScales {
  struct Part {
    int fields;
    T factor;
    bool is_velocity; ///< what blows up first, and alone is looked at, as in kernels/rk_update/update.hpp
  };
  Part parts[4];
  RateScales(const BodyConstants<T>& body, const ModelLayout& layout, bool is_gyroscopic) {
    const int force = layout.vec_size, turn = int(layout.wrench.size()) - force,
              rotor = int(layout.fields.size()) - 2 * force - turn;
    parts[0] = {force, T(1), false};
    parts[1] = {force, body.inverse_mass, true};
    parts[2] = {rotor, T(0.5), false};
    parts[3] = {turn, is_gyroscopic ? T(1) : body.inverse_inertia[2], true};
  }
};

template <class T, int W>
static RateScales<T> scales_of(const PackedRows<T, W>& packed, int r) {
  const PackedRow<T>& row = packed.rows[std::size_t(r)];
  return {*row.body, packed.layout, row.shape.terms.is_gyroscopic};
}

template <class T, int W>
std::vector<T> RhsExecutor<T, W>::scaled_rates(std::span<const double> signals) {
  rows_.copy_plain(plain_.data());
  evaluate(plain_.data(), signals);
  std::vector<T> rates(sums_.size());
  for (int r = 0; r < int(packed_.rows.size()); ++r) {
    std::size_t at = rows_.plain_offset(r);
    const RateScales<T> scales = scales_of(packed_, r);
    for (int pack = 0; pack < packed_.rows[std::size_t(r)].packs; ++pack)
      for (const auto& part : scales.parts)
        for (int n = 0; n < part.fields * W; ++n, ++at) rates[at] = part.factor * sums_.data()[at];
  }
  return rates;
}

template <class T, int W>
template <class Update>
int RhsExecutor<T, W>::each_row(Update&& update) {
  const int rows = int(packed_.rows.size());
  int failed = rows;
#pragma omp parallel num_threads(setup_.threads) reduction(min : failed)
  {
    const FlushDenormals guard;
#pragma omp for schedule(static)
    for (int r = 0; r < rows; ++r)
      if (!update(r)) failed = std::min(failed, r);
  }
  return failed == rows ? -1 : failed;
}

template <class T, int W>
template <class Physics>
int RhsExecutor<T, W>::update_stage(int stage) {
  const bool is_last = stage + 1 == setup_.method.stages;
  return each_row([&](int r) {
    RowTask<T> task;
    updates_[std::size_t(stage)].set(task, row(r), is_last ? row(r) : stage_row(stage, r),
                                     [&](int m) { return stage_row(m, r); });
    const RateScales<T> scales = scales_of(packed_, r);
    const T* const sums = sums_.data() + rows_.plain_offset(r);
    T check = 0; // 0 * x is 0 unless x is infinite or NaN
    std::size_t at = 0;
    for (int pack = 0; pack < packed_.rows[std::size_t(r)].packs; ++pack)
      for (const auto& part : scales.parts) {
        const T beta = task.beta * part.factor;
        for (const std::size_t end = at + std::size_t(part.fields * W); at < end; ++at) {
          const T y = task.base[at];
          task.out[at] = task.has_increments
                             ? Physics::rk_combined(y, beta, sums[at], task.increment[0][at], task.increment[1][at],
                                                    task.increment[2][at], task.alpha[0], task.alpha[1], task.alpha[2])
                             : Physics::rk_first(y, beta, sums[at]);
          if (part.is_velocity) check += task.out[at] * T(0);
        }
      }
    return !is_last || check == 0 || !packed_.first_failed(r, row(r), rows_.stored_fields());
  });
}

template <class T, int W>
template <class Physics>
int RhsExecutor<T, W>::leapfrog() {
  const T h = T(setup_.dt);
  return each_row([&](int r) {
    const RateScales<T> scales = scales_of(packed_, r);
    const PackedRow<T>& packed_row = packed_.rows[std::size_t(r)];
    const std::size_t stored = std::size_t(rows_.stored_fields() * W), plain = std::size_t(packed_.fields() * W);
    T check = 0;
    for (std::size_t lane = 0; lane < std::size_t(packed_row.packs * W); ++lane) {
      T* const y = row(r) + lane / W * stored + lane % W;
      const T* const sum = sums_.data() + rows_.plain_offset(r) + lane / W * plain + lane % W;
      typename Physics::element e, f;
      std::size_t at = 0;
      each_component(e, [&](T& c) { c = y[W * at++]; });
      at = 0;
      each_component(f, [&](T& c) { c = sum[W * at++]; });
      auto v_half = e.v;
      auto w_half = e.w;
      if (rows_.is_predicted()) {
        at = std::size_t(packed_.fields());
        each_component(v_half, [&](T& c) { c = y[W * at++]; });
        each_component(w_half, [&](T& c) { c = y[W * at++]; });
      }
      const auto next = Physics::leapfrog(e.u, e.q, v_half, w_half, Physics::vec_scale(scales.parts[1].factor, f.v),
                                          Physics::spin_scale(scales.parts[3].factor, f.w), h);
      at = 0;
      const auto store = [&](const T& c) { y[W * at++] = c; };
      const auto look = [&](const T& c) { check += c * T(0); }; // at what packs look at
      each_component(next.v_half, look), each_component(next.w_half, look);
      each_component(next.u, store);
      each_component(rows_.is_predicted() ? next.v_next : next.v_half, store);
      each_component(next.q, store);
      each_component(rows_.is_predicted() ? next.w_next : next.w_half, store);
      if (rows_.is_predicted()) each_component(next.v_half, store), each_component(next.w_half, store);
    }
    return check == 0 || !packed_.first_failed(r, row(r), rows_.stored_fields());
  });
}

template <class T, int W>
int RhsExecutor<T, W>::step(std::span<const double> signals) {
  const std::size_t width = signal_count(setup_.problem);
  const bool is_planar = setup_.model == Model::planar;
  int failed = -1;
  for (int s = 0; s < setup_.method.stages; ++s) {
    const T* in = s == 0 ? state_.data() : stages_[std::size_t(s - 1)].data();
    if (s == 0 && rows_.stored_fields() != packed_.fields()) rows_.copy_plain(plain_.data()), in = plain_.data();
    evaluate(in, signals.subspan(std::size_t(s) * width, width));
    if (rows_.is_leapfrog())
      failed = is_planar ? leapfrog<PlanarPhysics<T>>() : leapfrog<SpatialPhysics<T>>();
    else
      failed = is_planar ? update_stage<PlanarPhysics<T>>(s) : update_stage<SpatialPhysics<T>>(s);
  }
  return failed;
}

template <class T, int W>
Outcome RhsExecutor<T, W>::advance(long steps, std::span<const double> signals) {
  if (steps <= 0) return {};
  const std::size_t width = signal_count(setup_.problem), step_width = width * std::size_t(setup_.method.stages);
  if (rows_.is_leapfrog() && !is_started_) rows_.start(scaled_rates(signals.first(width)).data()), is_started_ = true;
  end_rates_.clear();
  end_signals_.assign(signals.end() - std::ptrdiff_t(width), signals.end());
  for (long n = 0; n < steps; ++n)
    if (const int r = step(signals.subspan(std::size_t(n) * step_width)); r >= 0)
      return {false, n, *packed_.first_failed(r, row(r), rows_.stored_fields())};
  return {true, steps, 0};
}

template <class T, int W>
std::string RhsExecutor<T, W>::schedule() const {
  return fmt::format("right-hand side on {}: {} bands of rows; the state goes there in every stage",
                     rates_.device().queue.device().entry.name, rates_.bands());
}

template <class T, int W>
std::size_t RhsExecutor<T, W>::bytes() const {
  std::size_t sum = state_.bytes() + plain_.bytes() + sums_.bytes() + rates_.device().bytes();
  for (const auto& stage : stages_) sum += stage.bytes();
  return sum;
}

template <class T, int W>
DeviceUse RhsExecutor<T, W>::device_use() const {
  return use_of(rates_.device(), rates_.device().queue.counts());
}

#define DSS_INSTANTIATE(T, W) template class RhsExecutor<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE

} // namespace dss::opencl
