/// Every shipped scene, turned by right angles or mirrored with all that acts on it: its elements
/// get other numbers and other places, and the same accelerations.
#include "solver/numerics/signal_rows.hpp"
#include "solver/reference/dynamics.hpp"
#include "solver/scene/scene.hpp"
#include "solver/scene/scene_text.hpp"
#include "tests/fixtures/problems.hpp"
#include "tests/fixtures/symmetry.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace dss {
namespace {

/// The first small version of each scene, those of single studies included.
std::vector<Problem> shipped_problems() {
  std::vector<Problem> problems;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scene_directory())) {
    if (entry.path().extension() != ".json") continue;
    const Scene whole = load_scene(entry.path().string());
    problems.push_back(
        load_scene(entry.path().string(), verify_overrides(whole.verify.front())).problem);
  }
  return problems;
}

/// Whether the material law treats axes apart that a symmetry exchanges: of two shears across a
/// link one (ShearAxes), and of rotations those about z. The mean axes of two elements are not at
/// right angles, so such a law is symmetric to second order in rotations only.
bool sets_axes_apart(const Problem& problem) {
  bool does = false;
  for (const Body& body : problem.bodies)
    body.each_kind([&](const AxisConstants& c, int axis) {
      const auto [base, third] = shear_axes(axis);
      for (const Vec3* const k : {&c.k_shear, &c.d_shear}) does |= (*k)[base] != (*k)[third];
      for (const Vec3* const k : {&c.k_rot, &c.d_rot})
        does |= (*k)[0] != (*k)[2] || (*k)[1] != (*k)[2];
    });
  return does;
}

std::vector<double> rates_of(const Problem& problem, Rotation rotation,
                             const std::vector<double>& state) {
  reference::Dynamics<double> dynamics(problem, rotation);
  std::vector<double> rates(state.size());
  dynamics.rates(state, signals_at(problem, 0.3 * problem.dt * double(problem.steps)), rates);
  return rates;
}

/// Largest difference of rates over all symmetries (of large bodies: over six), over the largest
/// rate of the same kind.
double asymmetry(const Problem& problem, Rotation rotation, double angle) {
  const double gap = 0.01 * angle * shortest_edge(problem);
  const std::vector<double> state = fixture::random_state(problem, 3, gap, angle, 0.1),
                            rates = rates_of(problem, rotation, state);
  const std::vector<fixture::Symmetry> all = fixture::all_symmetries();
  double worst = 0;
  const std::size_t stride = problem.lattice.element_count > 60 ? 7 : 1;
  for (std::size_t n = stride; n < all.size(); n += stride) { // 0 changes nothing
    const fixture::TransformedProblem other(problem, all[n]);
    const std::vector<double> expected = other.state(rates),
                              found = rates_of(other.problem(), rotation, other.state(state));
    for (const int first : {int(vx), int(wx)}) {
      double largest = 0, difference = 0;
      for (std::size_t at = 0; at < found.size(); at += field_count)
        for (std::size_t f = at + std::size_t(first); f < at + std::size_t(first) + 3; ++f) {
          largest = std::max(largest, std::abs(expected[f]));
          const double here = std::abs(found[f] - expected[f]);
          if (!(here <= difference)) difference = here; // also if NaN
        }
      if (!(difference <= worst * largest)) worst = difference / largest;
    }
  }
  return worst;
}

TEST(shipped_scenes, move_alike_when_they_are_turned_or_mirrored) {
  const std::vector<Problem> problems = shipped_problems();
  EXPECT_GT(problems.size(), 40U);
  for (const Problem& problem : problems) {
    if (!problem.has_rotating_frame()) {
      EXPECT_LT(asymmetry(problem, Rotation::linearised, 1), 1e-11) << problem.name;
    }
    const bool is_exact = !sets_axes_apart(problem);
    EXPECT_LT(asymmetry(problem, Rotation::quaternion, is_exact ? 1 : 1e-3),
              is_exact ? 1e-11 : 1e-3)
        << problem.name;
  }
}

} // namespace
} // namespace dss
