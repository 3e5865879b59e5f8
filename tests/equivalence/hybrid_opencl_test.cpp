/// Members of a hybrid on an OpenCL device and on the CPU, with equal and different pack widths. In
/// f64 a device has 8 numbers with AVX-512, 4 with AVX2, and 16 if it is used as a GPU.
#include "solver/numerics/stability.hpp"
#include "tests/equivalence/hybrid_run.hpp"
#include "tests/equivalence/opencl_run.hpp"

namespace dss::test {
namespace {

class HybridOnDevices : public Hybrid {
protected:
  void SetUp() override {
    Hybrid::SetUp();
    if (!has("opencl")) GTEST_SKIP() << "opencl is not here";
  }
};

TEST_F(HybridOnDevices, members_make_up_the_whole_to_the_last_bit_after_200_steps) {
  each_run(plugin_of("avx512"), [](const VariantRun& run, const State& start) {
    const State whole = run.after(start, 200);
    for (const char* members :
         {"avx512:1,opencl:1", "opencl:2=3,avx2:1=1", "avx2:1,opencl:1,avx512:2"}) {
      const JointRun joint{run.problem, run.method, members, run.precision, {}, run.model};
      EXPECT_EQ(differing_bits(whole, joint.after(start, 200), run.precision), 0u) << members;
    }
  });
}

TEST_F(HybridOnDevices, moves_of_elements_in_the_middle_of_a_run_change_no_bit) {
  each_run(plugin_of("avx512"), [](const VariantRun& run, const State& start) {
    if (run.problem.lattice.rows.size() < 9) return; // too few rows to move
    const State whole = run.after(start, 200);
    for (const char* members : {"avx512:1,opencl:1", "opencl:2=5,avx2:1=1"}) {
      int rebalances = 0;
      const JointRun joint{run.problem,   run.method,     members,
                           run.precision, swinging(2, 3), run.model};
      EXPECT_EQ(differing_bits(whole, joint.after(start, 200, &rebalances), run.precision), 0u)
          << members;
      EXPECT_GE(rebalances, 2) << members;
    }
  });
}

TEST_F(HybridOnDevices, what_a_device_did_is_counted_over_moves_of_elements) {
  const Problem problem = fixture::make_block(9, 24, 1, LinkLaw::paper);
  const Method& method = *find_method("rk4");
  constexpr long steps = 200;
  for (const char* kind : {"", "discrete"}) {
    const DeviceAs device(kind);
    const auto run =
        JointRun{problem, method, "avx2:1,opencl:1", Precision::f64, swinging(2, 3)}.executor();
    run->write(0, fixture::random_state(problem, 9, 1e-4, 0.02, 0.01));
    const DeviceUse before = device_use(*run);
    run->advance(steps, signal_rows(problem, method, problem.dt, 0, steps));
    const DeviceUse after = device_use(*run);
    EXPECT_GE(hybrid_info(*run).rebalances, 2) << kind;
    EXPECT_EQ(after.device.id, before.device.id) << kind;
    EXPECT_GE(after.launches - before.launches, double(steps)) << kind;
    EXPECT_GE(after.transfer_s, before.transfer_s) << kind;
    constexpr double row_bytes = 9 * field_count * sizeof(double);
    EXPECT_EQ(after.from_device_bytes - before.from_device_bytes > steps * row_bytes,
              std::string(kind) == "discrete");
  }
}

/// Parts of at least four halos; one part has neighbours on both sides.
TEST_F(HybridOnDevices, edges_that_go_before_the_rest_have_the_bits_of_the_whole) {
  const Problem problem = fixture::make_block(9, 80, 1, LinkLaw::paper);
  for (const char* kind : {"", "discrete"}) {
    const DeviceAs device(kind);
    for (const Method& method : brief_methods()) {
      const State start = fixture::random_state(problem, 9, 1e-4, 0.02, 0.01);
      const State whole = VariantRun{plugin_of("avx512"), problem, method}.after(start, 100);
      for (const char* members :
           {"avx512:1,opencl:2", "avx2:1,opencl:1,avx512:1", "opencl:1,opencl:2"})
        EXPECT_EQ(differing_bits(whole, JointRun{problem, method, members}.after(start, 100),
                                 Precision::f64),
                  0u)
            << method.name << ' ' << members << ' ' << kind;
    }
  }
}

TEST_F(HybridOnDevices, members_taken_for_gpus_have_the_bits_of_the_whole) {
  const DeviceAs gpu("gpu");
  const Problem problem = fixture::make_block(19, 24, 1, LinkLaw::paper);
  for (const Method& method : brief_methods()) {
    const State start = fixture::random_state(problem, 9, 1e-4, 0.02, 0.01);
    const State whole = VariantRun{plugin_of("avx512"), problem, method}.after(start, 20);
    for (const char* members : {"avx512:1,opencl:1", "opencl:1,opencl:1"})
      EXPECT_EQ(differing_bits(whole, JointRun{problem, method, members}.after(start, 20),
                               Precision::f64),
                0u)
          << method.name << ' ' << members;
  }
}

TEST_F(HybridOnDevices, the_first_failure_is_that_of_packs) {
  const Problem problem = fixture::make_block(9, 17, 1, LinkLaw::paper);
  const State start = fixture::random_state(problem, 5, 1e-20, 1e-18, 1e-18);
  for (const Method& method : brief_methods()) {
    const double dt = 2 * stable_step(problem, method).dt;
    const auto failure = [&](Executor& run) {
      run.write(0, start);
      return run.advance(2000, signal_rows(problem, method, dt, 0, 2000));
    };
    const Outcome single =
        failure(*plugin_of("avx512").create({problem, method, Model::spatial, Precision::f64, dt}));
    ASSERT_FALSE(single.is_finite) << method.name;
    for (const char* members : {"avx512:1,opencl:1", "opencl:2,avx2:1"}) {
      const Outcome joint = failure(
          *JointRun{problem, method, members, Precision::f64, {}, Model::spatial, dt}.executor());
      EXPECT_FALSE(joint.is_finite) << method.name << ' ' << members;
      EXPECT_EQ(joint.step, single.step) << method.name << ' ' << members;
      EXPECT_EQ(joint.element, single.element) << method.name << ' ' << members;
    }
  }
}

} // namespace
} // namespace dss::test
