#include "experiments/studies/failures/closed_forms.hpp"
#include "experiments/studies/failures/free_top.hpp"

#include <cmath>
#include <complex>

namespace dss {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Vector3d vector_of(const double* fields, Field first) {
  return {fields[first], fields[first + 1], fields[first + 2]};
}
Quaterniond turn_of(const double* fields) {
  return {1 + fields[qs], fields[qx], fields[qy], fields[qz]};
}

void place(double* fields, Field first, const Vector3d& v) {
  for (int axis = 0; axis < 3; ++axis) fields[first + axis] = v[axis];
}

void place(double* fields, const Quaterniond& q) {
  fields[qs] = q.w() - 1;
  place(fields, qx, q.vec());
}

std::vector<double> flight(const Problem& problem, const Parameters& arguments, double t) {
  std::vector<double> state = initial_state(problem);
  const Vector3d a(arguments.at("ax"), arguments.at("ay"), arguments.at("az"));
  for (std::size_t e = 0; e < problem.lattice.element_count; ++e) {
    double* f = &state[e * field_count];
    const Vector3d v = vector_of(f, vx), w = vector_of(f, wx);
    place(f, ux, vector_of(f, ux) + v * t + a * t * t / 2);
    place(f, vx, v + a * t);
    if (w.norm() > 0) place(f, AngleAxisd(w.norm() * t, w.normalized()) * turn_of(f));
  }
  return state;
}

std::vector<double> tops(const Problem& problem, const Parameters&, double t) {
  std::vector<double> state = initial_state(problem);
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int) {
    double* f = &state[e * field_count];
    const Vec3& inertia = problem.bodies[std::size_t(row.body)].inertia;
    const Attitude end = free_top(Vector3d(inertia.data()), {turn_of(f), vector_of(f, wx)}, t);
    place(f, ux, vector_of(f, ux) + t * vector_of(f, vx));
    place(f, end.q);
    place(f, wx, end.w);
  });
  return state;
}

std::vector<double> steady_precession(const Problem& problem, const Parameters& arguments,
                                      double t) {
  std::vector<double> state = initial_state(problem);
  const auto top = std::size_t(arguments.at("element"));
  const Vector3d pivot(arguments.at("pivot_x"), arguments.at("pivot_y"), arguments.at("pivot_z")),
      z = Vector3d::UnitZ();
  const double precession = arguments.at("precession"), spin = arguments.at("spin");
  problem.lattice.for_each_element([&](std::size_t e, const Row& row, int x) {
    if (e != top) return;
    double* f = &state[e * field_count];
    const Vec3 rest = rest_position(problem, row, x);
    const Vector3d centre(rest.data());
    const Quaterniond turn(AngleAxisd(precession * t, z)),
        q = turn * turn_of(f) * AngleAxisd(spin * t, z);
    const Vector3d arm = turn * (centre + vector_of(f, ux) - pivot);
    place(f, ux, pivot + arm - centre);
    place(f, vx, precession * z.cross(arm));
    place(f, q);
    place(f, wx, precession * z + spin * (q * z));
  });
  return state;
}

/// Damped oscillation x'' + rate x' + omega^2 x = 0 from x(0) = 1 at rest: x = exp(a t) (cos b t -
/// a/b sin b t) with a = -rate/2 and a^2 + b^2 = omega^2. The complex form below also covers the
/// overdamped case. All displacements follow x(t).
std::vector<double> mode(const Problem& problem, const Parameters& arguments, double t) {
  const double omega = arguments.at("omega"), rate = arguments.at("rate");
  const double discriminant = rate * rate / 4 - omega * omega;
  double place_now = 0, slope = 0;
  if (discriminant == 0) {
    place_now = (1 + omega * t) * std::exp(-omega * t);
    slope = -omega * omega * t * std::exp(-omega * t);
  } else {
    const std::complex<double> root = std::sqrt(std::complex<double>(discriminant));
    const std::complex<double> fast = -rate / 2 - root,
                               slow = omega * omega / fast; // avoids cancellation
    const std::complex<double> of_slow = std::exp(slow * t), of_fast = std::exp(fast * t),
                               gap = slow - fast;
    place_now = ((slow * of_fast - fast * of_slow) / gap).real();
    slope = (omega * omega * (of_fast - of_slow) / gap).real();
  }
  std::vector<double> state = initial_state(problem);
  for (std::size_t e = 0; e < problem.lattice.element_count; ++e)
    for (int axis = 0; axis < 3; ++axis) {
      state[e * field_count + vx + std::size_t(axis)] =
          slope * state[e * field_count + ux + std::size_t(axis)];
      state[e * field_count + ux + std::size_t(axis)] *= place_now;
    }
  return state;
}

std::vector<double> step_load(const Problem& problem, const Parameters& arguments, double t) {
  std::vector<double> state = initial_state(problem);
  const double omega = arguments.at("omega"), hold = arguments.at("static"),
               since = t - arguments.at("onset");
  double* f = &state.at(std::size_t(arguments.at("element")) * field_count);
  if (since <= 0) return state;
  const double half = std::sin(omega * since / 2);
  f[ux] = 2 * hold * half * half;
  f[vx] = hold * omega * std::sin(omega * since);
  return state;
}

} // namespace

const std::vector<ClosedForm>& closed_forms() {
  static const std::vector<ClosedForm> all = {
      {"flight", {"ax", "ay", "az"}, flight},
      {"free_top", {}, tops},
      {"steady_precession",
       {"element", "precession", "spin", "pivot_x", "pivot_y", "pivot_z"},
       steady_precession},
      {"mode", {"omega", "rate"}, mode},
      {"step_load", {"element", "omega", "static", "onset"}, step_load}};
  return all;
}

} // namespace dss
