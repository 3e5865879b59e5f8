#include "experiments/run/state/random_state.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace dss {
namespace {

constexpr double largest_angle = 2.5; ///< [rad]

/// Uniform in [-1, 1), made from the generator's bits: the distributions of the standard library
/// differ between implementations.
class Symmetric {
public:
  explicit Symmetric(unsigned seed) : generator_(seed) {}
  double operator()() { return 2 * (double(generator_() >> 11) * 0x1p-53) - 1; }

private:
  std::mt19937_64 generator_;
};

bool has(Model model, Field field) {
  const auto fields = descriptor(model).fields;
  return std::ranges::find(fields, field) != fields.end();
}

void set_rotation(double* fields, Model model, Symmetric& random) {
  double axis[3] = {random(), random(), random()};
  const double angle = largest_angle * random();
  for (int a = 0; a < 3; ++a)
    if (!has(model, Field(qx + a))) axis[a] = 0;
  if (model == Model::axial) return;
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  for (int a = 0; a < 3; ++a) fields[qx + a] = axis[a] / length * std::sin(angle / 2);
  fields[qs] = -2 * std::sin(angle / 4) * std::sin(angle / 4);
}

} // namespace

std::vector<double> random_state(const Problem& problem, Model model, Precision precision,
                                 unsigned seed) {
  Symmetric of_all(seed);
  std::vector<double> state(problem.lattice.element_count * field_count);
  problem.lattice.for_each_element([&](std::size_t element, const Row& row, int x) {
    Symmetric of_x(seed + unsigned(x)); // the axial model requires equal values in all rows
    Symmetric& random = model == Model::axial ? of_x : of_all;
    double* fields = &state[element * field_count];
    const Vec3& edge = problem.bodies[std::size_t(row.body)].edge;
    for (int a = 0; a < 3; ++a) {
      fields[ux + a] = 1e-2 * edge[std::size_t(a)] * random();
      fields[vx + a] = random();
      fields[wx + a] = 10 * random();
    }
    for (const Field field : {ux, uy, uz, vx, vy, vz, wx, wy, wz})
      if (!has(model, field)) fields[field] = 0;
    set_rotation(fields, model, random);
  });
  for (const Clamp& clamp : problem.clamps)
    for (int a = 0; a < 3; ++a) {
      double* fields = &state[clamp.element * field_count];
      if (clamp.dofs & (dof_ux << a)) fields[vx + a] = 0;
      if (clamp.dofs & (dof_rx << a)) fields[wx + a] = 0;
    }
  if (is_single(precision))
    for (double& field : state) field = double(float(field));
  return state;
}

} // namespace dss
