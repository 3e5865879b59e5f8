#include "solver/model/problem.hpp"

#include "solver/digest.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>

namespace dss {
namespace {

Vec3 sum(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec3 difference(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A unit quaternion (1 + s, v), stored without the 1 (DESIGN.md section 3).
struct Turn {
  double s = 0;
  Vec3 v{};
};

/// From a rotation vector [rad]. s = cos(angle / 2) - 1 is computed as -2 sin^2(angle / 4), which
/// does not cancel.
Turn turn_of(const Vec3& rotation) {
  const double angle = std::hypot(rotation[0], rotation[1], rotation[2]);
  if (angle == 0) return {};
  const double quarter = std::sin(angle / 4), scale = std::sin(angle / 2) / angle;
  return {-2 * quarter * quarter, {scale * rotation[0], scale * rotation[1], scale * rotation[2]}};
}

/// Rotation `a`, then rotation `b`.
Turn product(const Turn& b, const Turn& a) {
  const Vec3 across = cross(b.v, a.v);
  Turn both;
  both.s = b.s + a.s + b.s * a.s - (b.v[0] * a.v[0] + b.v[1] * a.v[1] + b.v[2] * a.v[2]);
  for (std::size_t i = 0; i < 3; ++i)
    both.v[i] = (1 + b.s) * a.v[i] + (1 + a.s) * b.v[i] + across[i];
  return both;
}

/// (R - I) r, exact to rounding for small turns too.
Vec3 shift(const Turn& turn, const Vec3& r) {
  const Vec3 once = cross(turn.v, r), twice = cross(turn.v, once);
  Vec3 result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = 2 * ((1 + turn.s) * once[i] + twice[i]);
  return result;
}

Vec3 centre_of(const Problem& problem, std::size_t element) {
  const std::vector<Row>& rows = problem.lattice.rows;
  const auto after =
      std::upper_bound(rows.begin(), rows.end(), element,
                       [](std::size_t e, const Row& row) { return e < row.first_element; });
  const Row& row = *(after - 1);
  std::size_t e = row.first_element;
  const std::size_t end =
      after == rows.end() ? problem.lattice.element_count : after->first_element;
  if (end - e == std::size_t(row.x_end - row.x_begin)) // a row without holes
    return rest_position(problem, row, row.x_begin + int(element - e));
  for (int x = row.x_begin; x < row.x_end; ++x)
    if (problem.lattice.is_present(row, x) && e++ == element) return rest_position(problem, row, x);
  return {};
}

Vec3 vector_at(const double* fields, Field first) {
  return {fields[first], fields[first + 1], fields[first + 2]};
}
void place(double* fields, Field first, const Vec3& v) {
  std::copy(v.begin(), v.end(), fields + first);
}

/// Applies the motion after the earlier motions of the element.
void apply(const InitialMotion& motion, const Problem& problem, std::size_t element,
           double* fields) {
  const Turn turn = turn_of(motion.rotation);
  Vec3 u = sum(vector_at(fields, ux), motion.displacement),
       v = sum(vector_at(fields, vx), motion.velocity);
  if (motion.is_rigid) {
    const Vec3 rest = centre_of(problem, element);
    u = sum(u, shift(turn, difference(sum(rest, vector_at(fields, ux)), motion.centre)));
    v = sum(v, cross(motion.angular_velocity, difference(sum(rest, u), motion.centre)));
  }
  const Turn turned = product(turn, {fields[qs], vector_at(fields, qx)});
  place(fields, ux, u);
  place(fields, vx, v);
  fields[qs] = turned.s;
  place(fields, qx, turned.v);
  place(fields, wx, sum(vector_at(fields, wx), motion.angular_velocity));
}

} // namespace

double shortest_edge(const Problem& problem) {
  double edge = std::numeric_limits<double>::infinity();
  for (const Body& body : problem.bodies)
    edge = std::min(edge, *std::ranges::min_element(body.edge));
  return edge;
}

Vec3 rest_position(const Problem& problem, const Row& row, int x) {
  const Body& body = problem.bodies[std::size_t(row.body)];
  return {body.origin[0] + (x + 0.5) * body.edge[0], body.origin[1] + (row.y + 0.5) * body.edge[1],
          body.origin[2] + (row.z + 0.5) * body.edge[2]};
}

void initial_state(const Problem& problem, std::size_t first, std::size_t count, double* fields) {
  std::fill(fields, fields + count * field_count, 0.0);
  for (const InitialMotion& motion : problem.initial_motions)
    for (const std::size_t element : motion.elements)
      if (element >= first && element - first < count)
        apply(motion, problem, element, fields + (element - first) * field_count);
}

std::vector<double> initial_state(const Problem& problem) {
  std::vector<double> state(problem.lattice.element_count * field_count);
  initial_state(problem, 0, problem.lattice.element_count, state.data());
  return state;
}

std::string why_series_too_short(const Problem& problem, double end) {
  std::string why;
  problem.each_signal([&](const Signal& signal) {
    if (why.empty() && signal.last < end * (1 - 1e-12))
      why = fmt::format("the series {} ends at {:g} s, the run at {:g} s; give fewer steps or a "
                        "longer series, or \"hold\": true to keep its last value",
                        signal.source, signal.last, end);
  });
  return why;
}

std::string series_digest(const Problem& problem) {
  Digest digest;
  problem.each_signal([&](const Signal& signal) {
    for (const std::vector<double>* numbers : {&signal.times, &signal.values})
      for (const double number : *numbers) digest.add(std::bit_cast<std::uint64_t>(number));
  });
  return fmt::format("{:016x}", digest.value());
}

} // namespace dss
