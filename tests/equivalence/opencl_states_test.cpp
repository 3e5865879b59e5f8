/// States of the OpenCL variants equal those of the fastest CPU variant to the last bit, as
/// whatever kind the device is used. variant_equivalence_test.cpp tests what every variant must do,
/// hybrid_opencl_test.cpp tests members of hybrids.
#include "tests/equivalence/opencl_run.hpp"
#include "variants/opencl/device.hpp"

namespace dss::test {
namespace {

/// Where not all problems run: PoCL takes seconds to compile a program, and longest for work-items
/// with barriers.
bool is_chosen(const VariantRun& run) {
  return run.problem.name == "plate" || run.problem.name == "everything" ||
         run.problem.name == "pressed_plate";
}

TEST_F(OpenCl, states_have_the_bits_of_packs_after_200_steps_on_any_number_of_bands) {
  each_run(packs(), [](const VariantRun& run, const State& start) {
    const State expected = run.after(start, 200);
    for (const int bands : {1, 2, 3}) {
      const VariantRun other{load_variant("opencl"), run.problem, run.method, run.model,
                             run.precision,          bands};
      EXPECT_EQ(differing_bits(expected, other.after(start, 200), run.precision), 0u) << bands;
    }
  });
}
TEST_F(OpenCl, states_have_the_bits_of_packs_after_200_steps_of_its_right_hand_side) {
  each_run(packs(), [](const VariantRun& run, const State& start) {
    if (!is_chosen(run)) return;
    const VariantRun other{
        load_variant("opencl-rhs"), run.problem, run.method, run.model, run.precision, 2};
    EXPECT_EQ(differing_bits(run.after(start, 200), other.after(start, 200), run.precision), 0u);
  });
}

/// Links outside the grid run stage by stage: with all terms and both laws.
TEST_F(OpenCl, states_and_rates_have_the_bits_of_packs_on_a_gpu_where_links_are_outside_the_grid) {
  const DeviceAs gpu("gpu");
  each_run(packs(), [](const VariantRun& run, const State& start) {
    if (run.problem.name != "everything" || run.precision != Precision::f64) return;
    if (run.model != Model::spatial && run.method.name != "rk4") return;
    const VariantRun other{load_variant("opencl"), run.problem, run.method, run.model,
                           run.precision};
    EXPECT_NE(other.executor()->schedule().find("a work-item an element"), std::string::npos);
    EXPECT_EQ(differing_bits(run.after(start, 12), other.after(start, 12), run.precision), 0u);
    EXPECT_EQ(differing_bits(run.derivative(start), other.derivative(start), run.precision), 0u);
  });
}
TEST_F(OpenCl, states_and_rates_have_the_bits_of_packs_on_a_gpu_where_elements_have_pressures) {
  const DeviceAs gpu("gpu");
  each_run(packs(), [](const VariantRun& run, const State& start) {
    if (!run.problem.has_pressure() || run.precision != Precision::f64) return;
    const VariantRun other{load_variant("opencl"), run.problem, run.method, run.model,
                           run.precision};
    EXPECT_NE(other.executor()->schedule().find("two sweeps a stage"), std::string::npos);
    EXPECT_EQ(differing_bits(run.after(start, 12), other.after(start, 12), run.precision), 0u);
    EXPECT_EQ(differing_bits(run.derivative(start), other.derivative(start), run.precision), 0u);
  });
}
TEST_F(OpenCl, states_have_the_bits_of_packs_on_a_gpu) {
  const DeviceAs gpu("gpu");
  each_run(packs(), [](const VariantRun& run, const State& start) {
    const bool is_compensated = run.precision == Precision::f32c && run.method.name == "rk4";
    if (run.problem.name != "plate" ||
        (run.model == Model::spatial) == (run.precision == Precision::f32))
      return;
    if (run.precision == Precision::f32c && !is_compensated) return;
    for (const char* variant : {"opencl", "opencl-rhs"}) {
      const VariantRun other{load_variant(variant), run.problem, run.method, run.model,
                             run.precision};
      EXPECT_EQ(differing_bits(run.after(start, 12), other.after(start, 12), run.precision), 0u)
          << variant;
    }
  });
}

/// Reads, writes and saves a state on a device that does not share the memory of the host.
TEST_F(OpenCl, states_have_the_bits_of_packs_on_a_device_with_memory_of_its_own) {
  const DeviceAs device("discrete");
  EXPECT_FALSE(opencl::find_device("", Precision::f32).is_unified);
  each_run(packs(), [&](const VariantRun& run, const State& start) {
    if (run.precision == Precision::f32 || !is_chosen(run) || run.method.name == "dopri5") return;
    const VariantRun other{
        load_variant("opencl"), run.problem, run.method, run.model, run.precision, 2};
    EXPECT_EQ(differing_bits(run.after(start, 12), other.after(start, 12), run.precision), 0u);
  });
}

} // namespace
} // namespace dss::test
