/// States that stop being finite on a device. Step and element must be those of the fastest CPU
/// variant, and no band may go on alone.
#include "solver/numerics/stability.hpp"
#include "tests/equivalence/opencl_run.hpp"

namespace dss::test {
namespace {

/// The first failure of a run in calls of `at_once` steps. Outcome::step counts from the start of
/// the run.
Outcome first_failure(const VariantRun& run, const State& start, long at_once) {
  const auto executor = run.executor();
  executor->write(0, start);
  for (long n = 0; n < 2000; n += at_once) {
    Outcome outcome =
        executor->advance(at_once, signal_rows(run.problem, run.method, run.dt, n, at_once));
    outcome.step += n;
    if (!outcome.is_finite) return outcome;
  }
  return {};
}

void expect_the_failure_of_packs(const Plugin& packs, const char* variant,
                                 const std::vector<int>& bands) {
  const Problem problem = fixture::make_block(9, 17, 1, LinkLaw::paper);
  const State start = fixture::random_state(problem, 5, 1e-20, 1e-18, 1e-18);
  for (const Method& method : brief_methods()) {
    VariantRun run{packs, problem, method};
    run.dt = 2 * stable_step(problem, method).dt;
    const Outcome expected = first_failure(run, start, 1);
    ASSERT_FALSE(expected.is_finite) << method.name;
    for (const int count : bands)
      for (const long at_once : {1L, 7L, 2000L}) {
        const VariantRun other{load_variant(variant), problem, method, Model::spatial,
                               Precision::f64,        count,   run.dt};
        const Outcome outcome = first_failure(other, start, at_once);
        EXPECT_FALSE(outcome.is_finite);
        EXPECT_EQ(outcome.step, expected.step)
            << variant << ' ' << method.name << ' ' << count << ' ' << at_once;
        EXPECT_EQ(outcome.element, expected.element)
            << variant << ' ' << method.name << ' ' << count << ' ' << at_once;
      }
  }
}

TEST_F(OpenCl, failures_are_those_of_packs_in_any_batch_of_steps) {
  expect_the_failure_of_packs(packs(), "opencl", {1, 2, 3});
  expect_the_failure_of_packs(packs(), "opencl-rhs", {1, 3});
}

TEST_F(OpenCl, failures_are_those_of_packs_in_the_work_groups_of_a_gpu) {
  for (const char* tile : {"0", "8x9x4", "8x9x2"}) {
    SCOPED_TRACE(tile);
    const DeviceAs gpu("gpu", tile);
    expect_the_failure_of_packs(packs(), "opencl", {1});
  }
}

/// Far from the failure, the state is that of the failing step, or a few steps ahead of it.
TEST_F(OpenCl, failures_in_one_band_stop_the_others) {
  const Problem calm = fixture::make_block(9, 90, 1, LinkLaw::paper);
  const long failing = 20, steps = 100000;
  Problem problem = calm;
  Signal late;
  late.kind = Signal::Kind::table;
  late.times = {0, double(failing) * problem.dt, double(failing + 1) * problem.dt};
  late.values = {0, 0, 1e300};
  problem.loads.push_back({{4}, {1e300, 0, 0}, {0, 0, 0}, late});
  const State start = fixture::random_state(problem, 6, 1e-4, 0.02, 0.01);
  const std::size_t far = problem.lattice.element_count - 1;
  for (const Method& method : brief_methods()) {
    const Outcome expected = first_failure({packs(), problem, method}, start, 1);
    ASSERT_FALSE(expected.is_finite) << method.name;
    ASSERT_GE(expected.step, failing) << method.name;
    for (const int bands : {2, 3}) {
      const auto run =
          VariantRun{load_variant("opencl"), problem, method, Model::spatial, Precision::f64, bands}
              .executor();
      run->write(0, start);
      const Outcome outcome =
          run->advance(steps, signal_rows(problem, method, problem.dt, 0, steps));
      EXPECT_EQ(outcome.step, expected.step) << method.name << ' ' << bands;
      EXPECT_EQ(outcome.element, expected.element) << method.name << ' ' << bands;
      State left(field_count);
      run->read(far, left);
      bool is_near = false;
      for (int ahead = 0; ahead < bands; ++ahead) {
        const State state =
            VariantRun{packs(), calm, method}.after(start, expected.step + 1 + ahead);
        is_near |=
            std::equal(left.begin(), left.end(), state.begin() + std::ptrdiff_t(far * field_count));
      }
      EXPECT_TRUE(is_near) << method.name << ' ' << bands;
    }
  }
}

} // namespace
} // namespace dss::test
