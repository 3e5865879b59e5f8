#include "experiments/run/state/random_state.hpp"
#include "experiments/run/state/state_access.hpp"
#include "experiments/run/verify/verify.hpp"
#include "solver/error.hpp"
#include "tests/fixtures/problems.hpp"
#include "tests/fixtures/spinning_element.hpp"
#include "variants/loading/loader.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace dss {
namespace {

TEST(Verify, RandomStatesAreUnitRotationsAndRespectClamps) {
  const Problem problem = fixture::make_plate(5);
  const std::vector<double> state = random_state(problem, Model::spatial, Precision::f64, 7);
  double largest_rotation = 0;
  for (std::size_t e = 0; e < state.size(); e += field_count) {
    const double w = 1 + state[e + qs];
    EXPECT_NEAR(w * w + state[e + qx] * state[e + qx] + state[e + qy] * state[e + qy] +
                    state[e + qz] * state[e + qz],
                1, 1e-14);
    largest_rotation = std::max(largest_rotation, 2 * std::acos(std::abs(w)));
  }
  EXPECT_GT(largest_rotation, 1);
  for (int field = vx; field < qs; ++field)
    EXPECT_EQ(state[std::size_t(field)], 0) << "element 0 is clamped";
}

TEST(StateDigest, TakesZerosOfEitherSignAndFlushedNumbersForEqual) {
  const auto digest = [](Precision precision, std::vector<double> fields) {
    StateDigest result(precision);
    result.add(fields);
    return result.value();
  };
  EXPECT_EQ(digest(Precision::f64, {0.0, 1.0}), digest(Precision::f64, {-0.0, 1.0}));
  EXPECT_EQ(digest(Precision::f64, {0x1p-1001}), digest(Precision::f64, {0.0}));
  EXPECT_EQ(digest(Precision::f32, {0x1p-121}), digest(Precision::f32, {0.0}));
  EXPECT_NE(digest(Precision::f64, {0x1p-121}), digest(Precision::f64, {0.0}));
  EXPECT_NE(digest(Precision::f64, {1.0}), digest(Precision::f64, {1.0 + 0x1p-52}));
  EXPECT_NE(digest(Precision::f64, {1.0, 2.0}), digest(Precision::f64, {2.0, 1.0}));
}

TEST(StateError, IsInfiniteWhereANumberIsMissing) {
  const Problem problem = fixture::make_plate(4);
  const std::vector<double> expected = random_state(problem, Model::spatial, Precision::f64, 7);
  std::vector<double> actual = expected;
  EXPECT_EQ(state_error(problem, expected, actual), 0);
  actual[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(state_error(problem, expected, actual), std::numeric_limits<double>::infinity());
}

TEST(VerifyScene, WithoutDevicesLeavesOutVariantsOnThemAndGivesHybridsNone) {
  std::vector<const Plugin*> plugins = {&load_variant("scalar")};
  for (const char* name : {"opencl", "hybrid"}) try {
      plugins.push_back(&load_variant(name));
    } catch (const InputError&) { // not in this build
    }
  const Scene scene = load_scene("two_bodies", {});
  for (const VerifyRow& row : verify_scene(scene, 2, plugins, no_device)) {
    EXPECT_NE(row.verdict, VerifyRow::Verdict::failed)
        << row.variant << " " << row.check << ": " << row.reason;
    EXPECT_NE(row.variant, "opencl");
  }
  if (std::string_view(plugins.back()->name) != "hybrid") return;
  const Problem& problem = scene.problem;
  const Method& rk4 = *find_method("rk4");
  dss::Setup setup{problem, rk4, Model::spatial, Precision::f64, problem.dt, 2};
  setup.device = no_device;
  for (const HybridInfo::Entry& member : hybrid_info(*plugins.back()->create(setup)).members)
    EXPECT_FALSE(member.member.starts_with("opencl")) << member.member;
}

TEST(VerifyScene, JudgesFastRotationsByTheOrderThatSmallerStepsShow) {
  const Scene scene = fixture::spinning_element();
  int by_order = 0;
  for (const VerifyRow& row : verify_scene(scene, 40, {&load_variant("scalar")}, no_device)) {
    EXPECT_NE(row.verdict, VerifyRow::Verdict::failed)
        << row.model << " " << row.precision << " " << row.check << ": " << row.reason;
    by_order += row.reason.starts_with("falls by") && *row.error > 0.1 && std::isfinite(*row.error);
  }
  EXPECT_GT(by_order, 0);
}

} // namespace
} // namespace dss
