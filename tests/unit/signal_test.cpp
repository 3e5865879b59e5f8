#include "solver/model/signal.hpp"

#include "solver/numerics/signal_rows.hpp"
#include "tests/fixtures/problems.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dss {
namespace {

Signal of_kind(Signal::Kind kind) {
  Signal signal;
  signal.kind = kind;
  signal.amplitude = 4;
  return signal;
}

TEST(signal, a_constant_is_its_amplitude_plus_its_offset) {
  Signal signal = of_kind(Signal::Kind::constant);
  signal.offset = 0.5;
  EXPECT_EQ(signal(0), 4.5);
  EXPECT_EQ(signal(1e9), 4.5);
}

TEST(signal, a_ramp_grows_linearly_and_then_stays) {
  Signal signal = of_kind(Signal::Kind::ramp);
  signal.duration = 2;
  EXPECT_EQ(signal(-1), 0);
  EXPECT_EQ(signal(0), 0);
  EXPECT_EQ(signal(0.5), 1);
  EXPECT_EQ(signal(2), 4);
  EXPECT_EQ(signal(7), 4);
}

TEST(signal, a_harmonic_has_its_frequency_in_hertz_and_its_phase_in_radians) {
  Signal signal = of_kind(Signal::Kind::harmonic);
  signal.frequency = 5;
  EXPECT_NEAR(signal(0.05), 4, 1e-14);
  EXPECT_NEAR(signal(0.15), -4, 1e-14);
  signal.phase = std::numbers::pi / 2;
  signal.offset = 1;
  EXPECT_NEAR(signal(0), 5, 1e-14);
}

TEST(signal, a_table_is_linear_between_its_points_and_constant_outside) {
  Signal signal = of_kind(Signal::Kind::table);
  signal.times = {1, 2, 4};
  signal.values = {0, 1, -1};
  EXPECT_EQ(signal(0), 0);
  EXPECT_EQ(signal(1.5), 2);
  EXPECT_EQ(signal(2), 4);
  EXPECT_EQ(signal(3), 0);
  EXPECT_EQ(signal(9), -4);
}

TEST(signal, kinks_are_where_a_ramp_ends_and_at_the_points_of_a_table) {
  Signal signal = of_kind(Signal::Kind::ramp);
  signal.duration = 2;
  EXPECT_EQ(kinks(signal), std::vector<double>{2});
  signal = of_kind(Signal::Kind::table);
  signal.times = {1, 2, 4};
  EXPECT_EQ(kinks(signal), signal.times);
  EXPECT_TRUE(kinks(of_kind(Signal::Kind::harmonic)).empty());
}

TEST(signal_rows, hold_the_values_at_every_stage_and_at_the_end) {
  const Problem problem = fixture::make_everything();
  const Method& method = *find_method("rk4");
  const double dt = 1e-3;
  const auto width = std::size_t(signal_count(problem));
  const std::vector<double> rows = signal_rows(problem, method, dt, 5, 3);
  ASSERT_EQ(rows.size(), (3 * 4 + 1) * width);
  for (std::size_t r = 0; r <= 12; ++r) {
    const double t = r == 12 ? 8 * dt : (5 + double(r / 4) + method.node[r % 4]) * dt;
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_EQ(rows[r * width + a], problem.frame_acceleration[a](t));
    for (std::size_t l = 0; l < problem.loads.size(); ++l)
      EXPECT_EQ(rows[r * width + 3 + l], problem.loads[l].signal(t));
  }
}

TEST(signal_rows, of_two_runs_in_turn_are_those_of_one) {
  const Problem problem = fixture::make_everything();
  const Method& method = *find_method("velocity_verlet");
  const auto width = std::ptrdiff_t(signal_count(problem));
  const std::vector<double> whole = signal_rows(problem, method, 1e-3, 0, 10);
  std::vector<double> parts = signal_rows(problem, method, 1e-3, 0, 4);
  const std::vector<double> second = signal_rows(problem, method, 1e-3, 4, 6);
  parts.resize(parts.size() - std::size_t(width));
  parts.insert(parts.end(), second.begin(), second.end());
  EXPECT_EQ(parts, whole);
}

} // namespace
} // namespace dss
