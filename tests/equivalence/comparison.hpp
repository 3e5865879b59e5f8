#pragma once
/// Runs a problem on a variant and compares states: with the oracle by tolerance, with variants
/// with FMA to the last bit.
#include "kernels/model.hpp"
#include "solver/model/rotation_vector.hpp"
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/oracle.hpp"
#include "tests/fixtures/schemes.hpp"
#include "variants/loading/loader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace dss::test {

using State = std::vector<double>;

/// Whether this build and CPU have a variant.
inline bool has(std::string_view name) {
  const auto found = std::ranges::find(asked_variants(), name, &VariantStatus::name);
  return found != asked_variants().end() && found->is_usable();
}

/// The name of a test of a variant: tests take no hyphens.
inline std::string name_of_variant(const testing::TestParamInfo<std::string>& variant) {
  std::string name = variant.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

inline State poisoned(const Problem& problem) {
  return State(problem.lattice.element_count * field_count,
               std::numeric_limits<double>::quiet_NaN());
}

/// Rounds every number to the precision of the variant, so that the oracle starts from the same
/// state.
inline State rounded(State state, Precision precision) {
  if (precision == Precision::f32)
    for (double& x : state) x = double(float(x));
  return state;
}

/// Removes motions that leave the plane z = const: the part that the planar model can hold.
inline State flattened(State state) {
  for (std::size_t at = 0; at < state.size(); at += field_count) {
    for (const Field f : {uz, vz, wx, wy}) state[at + f] = 0;
    const double norm = std::hypot(1 + state[at + qs], state[at + qz]);
    state[at + qz] /= norm;
    state[at + qs] = (1 + state[at + qs]) / norm - 1;
    state[at + qx] = state[at + qy] = 0;
  }
  return state;
}

/// The part of a state that a model can hold. Of an orientation, that is the part of its rotation
/// vector, or of its rotation in the plane.
inline State restricted(State state, Model model) {
  if (model == Model::planar) return flattened(std::move(state));
  const ModelDescriptor& layout = descriptor(model);
  for (std::size_t at = 0; at < state.size() && model != Model::spatial; at += field_count) {
    const auto fields = std::span(state).subspan(at, field_count);
    to_rotation_vector(fields);
    for (int f = 0; f < field_count; ++f)
      if (std::ranges::find(layout.fields, Field(f)) == layout.fields.end())
        fields[std::size_t(f)] = 0;
    to_quaternion(fields);
  }
  return state;
}
/// The same for rates at a state that the model can hold.
inline State restricted_rates(State rates, Model model) {
  const ModelDescriptor& layout = descriptor(model);
  for (std::size_t at = 0; at < rates.size(); ++at) {
    const auto field = Field(at % field_count);
    if (field != qs && std::ranges::find(layout.fields, field) == layout.fields.end())
      rates[at] = 0;
  }
  return rates;
}

/// Whether a variant computes with kernels that are not its own: on devices, by members, on ranks.
/// Those kernels have tests of their own.
inline bool is_composed(const Plugin& plugin) {
  return plugin.kernels == nullptr && !plugin.has_all;
}

/// Methods that a variant is tested with: all, or few if its bits are those of the fastest variant.
inline std::vector<Method> distinct_methods(const Plugin& plugin) {
  return plugin.has_fma && plugin.name != std::string_view(load_variant("auto").name)
             ? brief_methods()
             : methods();
}

struct VariantRun {
  const Plugin& plugin;
  const Problem& problem;
  const Method& method;
  Model model = Model::spatial;
  Precision precision = Precision::f64;
  int threads = 1;
  double dt = problem.dt;
  int tile = 0;

  std::unique_ptr<Executor> executor() const {
    Setup setup{problem, method, model, precision, dt, threads};
    setup.tile = tile;
    return plugin.create(setup);
  }
  State derivative(const State& state) const {
    const auto run = executor();
    run->write(0, state);
    State rates = poisoned(problem);
    const std::vector<double> signals = signal_rows(problem, method, dt, 0, 1);
    run->derivative(std::span(signals).first(signal_count(problem)), rates);
    return rates;
  }
  /// After `steps` steps in two calls of advance, so that a restart between them is always tested.
  State after(const State& state, long steps) const {
    const auto run = executor();
    run->write(0, state);
    const long first = steps / 3;
    run->advance(first, signal_rows(problem, method, dt, 0, first));
    run->advance(steps - first, signal_rows(problem, method, dt, first, steps - first));
    State result = poisoned(problem);
    run->read(0, result);
    return result;
  }
};

/// With the equations of a model: the part of the results that it has. That is all of them if its
/// degrees of freedom suffice, or if the equations are linear.
inline State oracle_derivative(const Problem& problem, const Method& method, const State& state,
                               Model model = Model::spatial) {
  Oracle<long double> oracle(problem, method, problem.dt, rotation_of(model));
  oracle.write(state);
  State rates = poisoned(problem);
  oracle.derivative(0.0, rates);
  return restricted_rates(std::move(rates), model);
}
inline State oracle_after(const Problem& problem, const Method& method, const State& state,
                          long steps, Model model = Model::spatial,
                          Rotation finite = Rotation::quaternion) {
  const Rotation rotation = rotation_of(model);
  Oracle<long double> oracle(problem, method, problem.dt,
                             rotation == Rotation::quaternion ? finite : rotation);
  oracle.write(state);
  oracle.advance(steps);
  State result = poisoned(problem);
  oracle.read(result);
  return model == Model::planar
             ? result
             : restricted(std::move(result), model); // flattening would repair |q|
}

/// Largest difference over a group of fields (u, v, q, w), relative to the group's largest
/// magnitude in `expected`. The worst group counts. NaN gives infinity.
inline double relative_error(const State& actual, const State& expected) {
  constexpr int groups[][2] = {{ux, uz}, {vx, vz}, {qs, qz}, {wx, wz}};
  double worst = 0;
  for (const auto& [from, to] : groups) {
    double difference = 0, scale = 0;
    for (std::size_t at = 0; at < expected.size(); at += field_count)
      for (int f = from; f <= to; ++f) {
        const double d = std::abs(actual[at + std::size_t(f)] - expected[at + std::size_t(f)]);
        difference =
            std::isnan(d) ? std::numeric_limits<double>::infinity() : std::max(difference, d);
        scale = std::max(scale, std::abs(expected[at + std::size_t(f)]));
      }
    if (difference > 0)
      worst =
          std::max(worst, scale > 0 ? difference / scale : std::numeric_limits<double>::infinity());
  }
  return worst;
}

/// Counts numbers whose bits differ. -0 counts as 0. So does what flushing denormals may remove
/// (DESIGN.md section 6).
inline std::size_t differing_bits(const State& a, const State& b, Precision precision) {
  const double tiny = precision == Precision::f64 ? 0x1p-1000 : 0x1p-120;
  std::size_t count = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const double x = std::abs(a[n]) < tiny ? 0 : a[n], y = std::abs(b[n]) < tiny ? 0 : b[n];
    count += x != y;
  }
  return count;
}

} // namespace dss::test
