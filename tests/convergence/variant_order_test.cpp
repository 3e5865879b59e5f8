/// Observed orders and errors of the compiled variants on shipped scenes, with rounding: what a
/// user gets.
#include "solver/scene/scene.hpp"
#include "tests/equivalence/comparison.hpp"
#include "tests/fixtures/problems.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace dss::test {
namespace {

/// The plate of n = 10 after 2 ms: the oracle in long double with a step 8 times shorter than the
/// paper's, converged to 1e-12.
class PlateAfterTwoMilliseconds : public testing::Test {
protected:
  static const Scene& scene() {
    static const Scene plate = load_scene("plate_paper", {{"n", "10"}});
    return plate;
  }
  static const State& reference() {
    static const State state = [] {
      Problem problem = scene().problem;
      problem.dt = 1e-6 / 8;
      return oracle_after(problem, *find_method("rk4"), fixture::rest(problem), 16000);
    }();
    return state;
  }
  static State run(const Plugin& plugin, const char* method, double dt, Precision precision,
                   Model model = Model::spatial) {
    return VariantRun{plugin, scene().problem, *find_method(method), model, precision, 1, dt}.after(
        fixture::rest(scene().problem), std::lround(2e-3 / dt));
  }
  /// Largest error of a displacement over the largest displacement.
  static double error(const State& state) {
    double difference = 0, scale = 0;
    for (std::size_t at = 0; at < state.size(); at += field_count)
      for (std::size_t f = at + ux; f <= at + uz; ++f) {
        const double here = std::abs(state[f] - reference()[f]);
        if (!(here <= difference)) difference = here; // also if NaN
        scale = std::max(scale, std::abs(reference()[f]));
      }
    return difference / scale;
  }
  static double order(const Plugin& plugin, const char* method, double dt) {
    return std::log2(error(run(plugin, method, dt, Precision::f64)) /
                     error(run(plugin, method, dt / 2, Precision::f64)));
  }
};

TEST_F(PlateAfterTwoMilliseconds, rk4_has_observed_order_four) {
  for (const char* variant : {"scalar", "auto"})
    EXPECT_NEAR(order(load_variant(variant), "rk4", 1e-6), 4, 0.1) << variant;
}

TEST_F(PlateAfterTwoMilliseconds, velocity_verlet_has_observed_order_two_with_the_papers_damping) {
  for (const char* variant : {"scalar", "auto"})
    EXPECT_NEAR(order(load_variant(variant), "velocity_verlet", 5e-7), 2, 0.1) << variant;
}

TEST_F(PlateAfterTwoMilliseconds,
       smoothed_verlet_bears_a_larger_step_than_velocity_verlet_and_has_its_order) {
  for (const char* variant : {"scalar", "auto"}) {
    EXPECT_NEAR(order(load_variant(variant), "smoothed_verlet", 1.25e-7), 2, 0.1) << variant;
    EXPECT_LT(error(run(load_variant(variant), "smoothed_verlet", 1.25e-6, Precision::f64)), 1e-3)
        << variant;
    EXPECT_FALSE(error(run(load_variant(variant), "velocity_verlet", 1.25e-6, Precision::f64)) < 1)
        << variant;
  }
}

TEST_F(PlateAfterTwoMilliseconds, float32_keeps_a_relative_error_below_1e_4_at_the_papers_step) {
  for (const char* variant : {"scalar", "auto"}) {
    const double e = error(run(load_variant(variant), "rk4", 1e-6, Precision::f32));
    RecordProperty(variant, std::to_string(e));
    EXPECT_LE(e, 1e-4) << variant;
    EXPECT_GT(e, 1e-8) << "this is not float32";
  }
}

/// Kept increments leave only the rounding of forces in single precision, which is the same at
/// every step. The rounding of float32 grows as steps shrink.
TEST_F(PlateAfterTwoMilliseconds,
       kept_low_parts_stop_the_error_that_float32_gains_as_steps_shrink) {
  for (const char* variant : {"scalar", "auto"}) {
    const auto error_of = [&](double dt, Precision precision) {
      const double e = error(run(load_variant(variant), "rk4", dt, precision));
      RecordProperty(fmt::format("{}_{}_{}", variant, name(precision), dt), fmt::format("{}", e));
      return e;
    };
    EXPECT_LT(error_of(1e-6, Precision::f32c), 2e-7) << variant;
    EXPECT_GT(error_of(1e-6, Precision::f32), 4 * error_of(1e-6, Precision::f32c)) << variant;
    EXPECT_LT(error_of(1.25e-7, Precision::f32c), 2e-7) << variant;
    EXPECT_GT(error_of(1.25e-7, Precision::f32), 10 * error_of(1.25e-7, Precision::f32c))
        << variant;
  }
}

TEST_F(PlateAfterTwoMilliseconds, planar_and_spatial_agree_to_1e_12) {
  for (const char* variant : {"scalar", "auto"}) {
    const Plugin& plugin = load_variant(variant);
    EXPECT_LE(relative_error(run(plugin, "rk4", 1e-6, Precision::f64, Model::planar),
                             run(plugin, "rk4", 1e-6, Precision::f64)),
              1e-12)
        << variant;
  }
}

/// u = u0 exp(-g t) (cos w t + g/w sin w t), g = d/2m, w^2 = k/m - g^2, as the scene says.
TEST(TwoElements, approach_their_closed_form_at_the_order_of_each_method) {
  const Scene scene = load_scene("two_elements");
  const double g = scene.parameters.at("d") / (2 * scene.parameters.at("mass")),
               u0 = scene.parameters.at("stretch");
  const double w = std::sqrt(scene.parameters.at("k") / scene.parameters.at("mass") - g * g),
               t = 0.1;
  const double exact = u0 * std::exp(-g * t) * (std::cos(w * t) + g / w * std::sin(w * t));
  const State start = initial_state(scene.problem);
  for (const char* variant : {"scalar", "auto"})
    for (const Method& method : methods()) {
      const auto error = [&](double dt) {
        const VariantRun run{
            load_variant(variant), scene.problem, method, Model::spatial, Precision::f64, 1, dt};
        return std::abs(run.after(start, std::lround(t / dt))[field_count + ux] - exact);
      };
      const double dt = method.order > 5 ? 2e-3 : 5e-4; // above rounding
      EXPECT_NEAR(std::log2(error(dt) / error(dt / 2)), method.order, 0.1)
          << variant << ' ' << method.name;
    }
}

} // namespace
} // namespace dss::test
