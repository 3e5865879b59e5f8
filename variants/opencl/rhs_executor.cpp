#include "variants/opencl/rhs_executor.hpp"

#include "kernels/rk_update/update.hpp"
#include "variants/api/tried_steps.hpp"
#include "variants/engine/packs.hpp"
#include "variants/isa/denormals.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace dss::opencl {

template <class T, int W>
RhsExecutor<T, W>::RhsExecutor(const Setup& setup, const Device& device, const Layout& layout)
    : setup_(setup), rates_(setup.problem, setup.model, nullptr, device, layout, false),
      rows_(packed_, setup_.method, setup_.precision, setup_.steps(),
            [this](int r) { return row(r); }),
      updates_(stage_updates<T>(setup_.method, rows_.storage(), W, setup_.steps())) {
  const std::size_t stored = packed_.readable_packs() * std::size_t(rows_.stored_fields() * W);
  state_ = dss::Buffer<T>(stored);
  plain_ = dss::Buffer<T>(rates_.size());
  sums_ = dss::Buffer<T>(rates_.size());
  const bool has_error = setup_.method.has_error_stage;
  for (int s = 0; s + 1 < setup_.method.stages + int(has_error); ++s) stages_.emplace_back(stored);
  if (has_error) own_lanes_ = own_lanes<T, W>(packed_, nullptr);
}

template <class T, int W>
T* RhsExecutor<T, W>::row_of(dss::Buffer<T>& rows, int r) {
  return rows.data() +
         packed_.rows[std::size_t(r)].pack_offset * std::size_t(rows_.stored_fields() * W);
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

/// Factors that turn the sums of the device into the rates of the fields, and the number of fields
/// that each factor has.
template <class T>
struct RateScales {
  struct Part {
    int fields;
    T factor;
  };
  Part parts[4];
  RateScales(const BodyConstants<T>& body, const ModelDescriptor& layout, bool is_gyroscopic) {
    const int force = layout.vec_size(), turn = layout.spin_size(),
              rotor = int(layout.fields.size()) - 2 * force - turn;
    parts[0] = {force, T(1)};
    parts[1] = {force, body.inverse_mass};
    parts[2] = {rotor, T(0.5)};
    parts[3] = {turn, is_gyroscopic ? T(1) : body.inverse_inertia[2]};
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
    for (int pack = 0; pack < packed_.rows[std::size_t(r)].packs;
         ++pack, at += std::size_t(rows_.storage().pressures * W))
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

// Uses the engine's own update, lane by lane.
template <class T, int W>
template <class Physics>
int RhsExecutor<T, W>::update_stage(int stage) {
  const bool is_last = stage + 1 == setup_.method.stages && !setup_.method.has_error_stage;
  return each_row([&](int r) {
    const PackedRow<T>& packed_row = packed_.rows[std::size_t(r)];
    RowTask<T> task;
    updates_[std::size_t(stage)].set(
        task, row(r), is_last ? row(r) : stage_row(stage, r),
        [&](int m) { return stage_row(m, r); }, step_);
    task.body = packed_row.body;
    const RateScales<T> scales = scales_of(packed_, r);
    RowUpdate<Physics, T, W> update(task,
                                    {task.beta, scales.parts[1].factor, scales.parts[3].factor});
    const T* const in = stage == 0 ? row(r) : stage_row(stage - 1, r);
    const T* const sums = sums_.data() + rows_.plain_offset(r);
    const auto element_at = [](const T* at) {
      typename Physics::element e;
      each_component(e, [&](T& c) { c = *at, at += W; });
      return e;
    };
    for (int lane = 0; lane < packed_row.packs * W; ++lane) {
      const std::ptrdiff_t at = lane / W * rows_.stored_fields() * W + lane % W;
      const auto sum = element_at(sums + lane / W * rows_.plain_fields() * W +
                                  lane % W); // the sums lie in the place of the rates
      update(at, element_at(in + at), sum.v, sum.w);
    }
    return update.is_finite() || !packed_.first_failed(r, row(r), rows_.stored_fields());
  });
}

template <class T, int W>
int RhsExecutor<T, W>::step(std::span<const double> signals) {
  const std::size_t width = signal_count(setup_.problem);
  int failed = -1;
  for (int s = 0; s < setup_.method.stages; ++s) {
    dss::Buffer<T>& in = s == 0 ? state_ : stages_[std::size_t(s - 1)];
    const bool is_plain = rows_.stored_fields() == rows_.plain_fields();
    if (!is_plain) rows_.copy_plain(plain_.data(), [&](int r) { return row_of(in, r); });
    evaluate(is_plain ? in.data() : plain_.data(), signals.subspan(std::size_t(s) * width, width));
    with_physics<T>(setup_.model, [&]<class P>() { failed = update_stage<P>(s); });
  }
  return failed;
}

template <class T, int W>
StepMaxima RhsExecutor<T, W>::try_step(double dt, std::span<const double> signals) {
  step_ = T(dt);
  step(signals);
  const int stages = setup_.method.stages;
  const std::size_t pack_size = std::size_t(rows_.stored_fields() * W);
  LaneMaxima<T, W> lanes;
  for (int r = 0; r < int(packed_.rows.size()); ++r)
    for (std::size_t p = 0; p < std::size_t(packed_.rows[std::size_t(r)].packs); ++p)
      lanes.add(stage_row(stages - 1, r) + p * pack_size, stage_row(stages - 2, r) + p * pack_size,
                own_lanes_[packed_.rows[std::size_t(r)].pack_offset + p], packed_.layout.fields);
  return lanes.maxima();
}

template <class T, int W>
void RhsExecutor<T, W>::accept_step() {
  each_row([&](int r) {
    const int packs = packed_.rows[std::size_t(r)].packs;
    accept_row(rows_.storage(), packs, W, stage_row(setup_.method.stages - 2, r), row(r));
    return true;
  });
}

template <class T, int W>
Outcome RhsExecutor<T, W>::advance(long steps, std::span<const double> signals) {
  if (steps <= 0) return {};
  if (setup_.method.has_error_stage) return advance_by_tries(*this, setup_, steps, signals);
  const std::size_t width = signal_count(setup_.problem),
                    step_width = width * std::size_t(setup_.method.stages);
  if (rows_.is_staggered() && !is_started_)
    rows_.start(scaled_rates(signals.first(width)).data()), is_started_ = true;
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
