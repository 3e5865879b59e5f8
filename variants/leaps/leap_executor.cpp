#include "variants/leaps/leap_executor.hpp"

#include "solver/error.hpp"
#include "solver/model/sufficiency/sufficiency.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/numerics/stability.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>
#include <utility>

namespace dss {
namespace {

constexpr int most_leaps_without_restart = 16;
/// Of a leap. Few states are computed beyond those of its time, and weights of signals, whose time
/// grows with the square, stay cheap.
constexpr double most_phase = 2000;
constexpr std::size_t piece_elements = 4096; ///< whose states are added while they are in cache

/// A bound of all frequencies. Polynomials grow beyond it, and the spectrum is found to 1e-4. Steps
/// that are short for it have a larger one.
double frequency_bound(const Problem& problem, double dt) {
  constexpr double margin = 1.001, least_phase = 1;
  return std::max(margin * found_spectrum(problem).omega_max, least_phase / dt);
}

/// The smallest linear model that serves, and what to give.
std::string linear_model_for(const Problem& problem) {
  for (const Model model : models)
    if (is_linear(model) && why_not(model, problem).empty())
      return fmt::format("give --model {}", name(model));
  return "give another --integrator";
}

/// Signals that are not the same in all rows.
std::vector<std::size_t> changing(std::span<const double> rows, std::size_t width) {
  std::vector<std::size_t> columns;
  for (std::size_t column = 0; column < width; ++column)
    for (std::size_t at = column; at < rows.size(); at += width)
      if (rows[at] != rows[column]) {
        columns.push_back(column);
        break;
      }
  return columns;
}

/// f(t + s) + f(t - s) for all rows of a leap from t.
std::vector<double> with_mirrored(std::span<const double> rows, std::span<const double> before,
                                  std::size_t width) {
  std::vector<double> sums(rows.begin(), rows.end());
  for (std::size_t row = 0; row < rows.size(); row += width)
    for (std::size_t column = 0; column < width; ++column)
      sums[row + column] += before[before.size() - width - row + column];
  return sums;
}

} // namespace

std::string why_not_exponential(const Method& method, const Problem& problem, Model model,
                                Precision precision, Rotation rotation) {
  if (!method.is_exponential) return {};
  if (rotation != Rotation::quaternion && rotation != Rotation::linearised)
    return fmt::format("is for linear models, the rotations {} are not; give another --integrator",
                       name(rotation));
  if (!is_linear(model))
    return fmt::format("is for linear models, {} is not one; {}", name(model),
                       linear_model_for(problem));
  if (problem.has_rotating_frame())
    return "is for frames that do not rotate; give another --integrator";
  if (!method.has_leaps()) return {};
  if (precision == Precision::f32c) return "has f64 and f32 alone; give one of them";
  if (spectrum_bound(problem).damping > 0)
    return "is for problems without damping; give --integrator faber";
  return {};
}

std::unique_ptr<Executor> make_executor(const Plugin& plugin, const Setup& setup) {
  if (const std::string why = why_not_exponential(setup.method, setup.problem, setup.model,
                                                  setup.precision, setup.rotation);
      !why.empty())
    throw InputError(fmt::format("--integrator {}: {}", setup.method.name, why));
  if (setup.method.has_leaps()) return std::make_unique<LeapExecutor>(plugin, setup);
  if (setup.method.stages == 0)
    throw std::logic_error(fmt::format("{} is not fitted to a step", setup.method.name));
  return plugin.create(setup);
}

LeapExecutor::LeapExecutor(const Plugin& plugin, const Setup& setup)
    : setup_(setup), omega_(frequency_bound(setup.problem, setup.dt)),
      method_(*find_method("symplectic_euler")) {
  if (setup.part != nullptr || setup.ensemble != nullptr)
    throw std::logic_error("leaps are of whole problems");
  inner_ = plugin.create({setup.problem, method_, setup.model, setup.precision, 2 / omega_,
                          setup.threads, nullptr, setup.distribution, setup.device, setup.members,
                          setup.rotation, setup.tile});
  width_ = std::size_t(kept_fields(*inner_));
  if (width_ == 0)
    throw InputError(fmt::format("--integrator {}: variant {} does not give out its state; give "
                                 "another --variant",
                                 setup.method.name, plugin.name));
  const auto has = [&](Field field) {
    return std::ranges::count(descriptor(setup.model).fields, field) > 0;
  };
  for (const Field field : {ux, uy, uz})
    if (has(field)) moving_.push_back({std::size_t(field), std::size_t(field - ux + vx), 1});
  for (const Field field : {qx, qy, qz})
    if (has(field)) moving_.push_back({std::size_t(field), std::size_t(field - qx + wx), 0.5});
  state_.resize(width_ * setup.problem.lattice.element_count);
  sum_.resize(state_.size());
  piece_.resize(width_ * std::min(piece_elements, setup.problem.lattice.element_count));
}

void LeapExecutor::move_inside() {
  if (!is_inside_) restore(*inner_, 0, state_);
  is_inside_ = true;
}

void LeapExecutor::write(std::size_t first, std::span<const double> fields) {
  move_inside();
  inner_->write(first, fields);
  const std::size_t count = fields.size() / field_count;
  save(*inner_, first, std::span(state_).subspan(first * width_, count * width_));
  before_.reset();
}

void LeapExecutor::read(std::size_t first, std::span<double> fields) {
  move_inside();
  inner_->read(first, fields);
}

void LeapExecutor::derivative(std::span<const double> signals, std::span<double> rates) {
  move_inside();
  inner_->derivative(signals, rates);
}

template <class Visit>
void LeapExecutor::each_moving(Visit&& visit) const {
  for (std::size_t element = 0; element < state_.size(); element += width_)
    for (const auto& [at, rate, half] : moving_) visit(element + at, element + rate, half);
}

bool LeapExecutor::is_moving() const {
  bool is_moving = false;
  each_moving([&](std::size_t, std::size_t rate, double) { is_moving |= state_[rate] != 0; });
  return is_moving;
}

LeapExecutor::Numbers LeapExecutor::of_displacements() const {
  Numbers numbers = state_;
  each_moving([&](std::size_t, std::size_t rate, double) { numbers[rate] = 0; });
  return numbers;
}

LeapExecutor::Numbers LeapExecutor::of_velocities() const {
  Numbers numbers = state_;
  each_moving([&](std::size_t displacement, std::size_t rate, double half) {
    numbers[displacement] = half * std::exchange(numbers[rate], 0) / omega_;
  });
  return numbers;
}

LeapExecutor::Numbers LeapExecutor::at_rest() const {
  Numbers numbers = state_;
  each_moving([&](std::size_t displacement, std::size_t rate, double) {
    numbers[displacement] = numbers[rate] = 0;
  });
  return numbers;
}

Outcome LeapExecutor::add_run(const Numbers& start, std::span<const double> signals,
                              const StateWeights& weights, double factor) {
  restore(*inner_, 0, start);
  is_inside_ = false;
  std::vector<double> rows(signals.begin(), signals.end());
  rows.insert(rows.end(), signals.begin(), signals.end()); // the stage, and the end of the step
  for (std::size_t n = 0; n < weights.displacement.size(); ++n) {
    if (n > 0) {
      const Outcome outcome = inner_->advance(1, rows);
      ++evaluations_;
      if (!outcome.is_finite) return {false, 0, outcome.element, outcome.what};
    }
    const double to_displacement = factor * weights.displacement[n],
                 to_velocity = factor * weights.velocity[n];
    for (std::size_t first = 0; first < state_.size(); first += piece_.size()) {
      const std::span<double> piece(piece_.data(), std::min(piece_.size(), state_.size() - first));
      save(*inner_, first / width_, piece);
      for (std::size_t element = 0; element < piece.size(); element += width_)
        for (const auto& [at, rate, half] : moving_) {
          sum_[first + element + at] += to_displacement * piece[element + at];
          sum_[first + element + rate] += to_velocity / half * piece[element + at];
        }
    }
  }
  return {};
}

Outcome LeapExecutor::add_runs(const LeapWeights& weights, std::span<const double> signals) {
  const std::size_t width = signal_count(setup_.problem);
  const std::span<const double> constant = signals.first(width);
  const std::vector<double> rows = before_ ? with_mirrored(signals, before_->rows, width)
                                           : std::vector<double>(signals.begin(), signals.end());
  if (const Outcome outcome =
          add_run(of_displacements(), constant, weights.of_displacement(), before_ ? 2 : 1);
      !outcome.is_finite)
    return outcome;
  if (!before_ && is_moving()) {
    const std::vector<double> none(width, 0);
    if (const Outcome outcome = add_run(of_velocities(), none, weights.of_velocity(), 1);
        !outcome.is_finite)
      return outcome;
  }
  const std::vector<std::size_t> columns = changing(rows, width);
  const std::vector<StateWeights> of_signals = weights.of_signals(rows, width, columns);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::vector<double> unit(width, 0);
    unit[columns[c]] = 1;
    if (const Outcome outcome = add_run(at_rest(), unit, of_signals[c], 1); !outcome.is_finite)
      return outcome;
  }
  return {};
}

void LeapExecutor::begin_sum() {
  sum_ = state_;
  each_moving([&](std::size_t displacement, std::size_t rate, double) {
    sum_[displacement] = before_ ? -before_->state[displacement] : 0;
    sum_[rate] = before_ ? before_->state[rate] : 0;
  });
}

Outcome LeapExecutor::leap(long steps, std::span<const double> signals) {
  const bool is_like_before = before_ && before_->steps == steps;
  if (!is_like_before || leaps_ >= most_leaps_without_restart) before_.reset();
  leaps_ = before_ ? leaps_ + 1 : 0;
  begin_sum();
  const Outcome outcome = add_runs({omega_, setup_.dt, steps}, signals);
  if (!outcome.is_finite) return outcome;
  const auto bad = std::ranges::find_if(sum_, [](double number) { return !std::isfinite(number); });
  if (bad != sum_.end()) return {false, 0, std::size_t(bad - sum_.begin()) / width_};
  before_ = Leap{steps, state_, {signals.begin(), signals.end()}};
  std::swap(state_, sum_);
  is_inside_ = false;
  return {true, steps};
}

Outcome LeapExecutor::advance(long steps, std::span<const double> signals) {
  const long most = std::max(1L, long(most_phase / (omega_ * setup_.dt)));
  const std::size_t row = signal_count(setup_.problem) * std::size_t(setup_.method.stages);
  long pieces = (steps + most - 1) / most;
  for (long step = 0; step < steps; --pieces) {
    const long count = (steps - step + pieces - 1) / pieces;
    const std::size_t rows = std::size_t(count) * row + signal_count(setup_.problem);
    Outcome outcome = leap(count, signals.subspan(std::size_t(step) * row, rows));
    outcome.step = step;
    if (!outcome.is_finite) return outcome;
    step += count;
  }
  return {true, steps};
}

std::string LeapExecutor::schedule() const {
  return fmt::format("leaps of steps of {:.4g} s: {}", 2 / omega_, inner_->schedule());
}

std::size_t LeapExecutor::bytes() const {
  return inner_->bytes() + (3 * state_.size() + piece_.size()) * sizeof(double);
}

} // namespace dss
