/// States of the OpenCL variants against those of the fastest CPU variant: equal to the last bit, whatever the device is taken for. What
/// every variant must do besides is in variant_equivalence_test.cpp, members of hybrids in hybrid_opencl_test.cpp.
#include "tests/equivalence/opencl_run.hpp"
#include "variants/opencl/device.hpp"

namespace dss::test {
namespace {

/// In f32 not with all terms, here and below: PoCL takes seconds to compile a program, and its text is that of f64 but for one word.
bool is_chosen(const VariantRun& run) { return run.problem.name == "plate" || run.problem.name == "everything"; }

void expect_the_bits_of(const Plugin& packs, const char* variant, const std::vector<int>& bands, bool has_all_f32) {
  each_run(packs, [&](const VariantRun& run, const State& start) {
    if (run.precision == Precision::f32 && !has_all_f32 && !is_chosen(run)) return;
    const State expected = run.after(start, 200);
    for (const int count : bands) {
      const VariantRun other{load_variant(variant), run.problem, run.method, run.model, run.precision, count};
      EXPECT_EQ(differing_bits(expected, other.after(start, 200), run.precision), 0u) << count;
    }
  });
}
TEST_F(OpenCl, states_have_the_bits_of_packs_after_200_steps_on_any_number_of_bands) {
  expect_the_bits_of(packs(), "opencl", {1, 2, 3}, true);
}
TEST_F(OpenCl, states_have_the_bits_of_packs_after_200_steps_of_its_right_hand_side) {
  expect_the_bits_of(packs(), "opencl-rhs", {2}, false);
}

/// Few steps, and a test a half of the problems: programs of work-items that meet at barriers take longest.
void expect_the_bits_of_a_gpu(const Plugin& packs, Precision precision, bool is_of_chosen) {
  const DeviceAs gpu("gpu");
  each_run(packs, [&](const VariantRun& run, const State& start) {
    if (run.precision != precision || is_chosen(run) != is_of_chosen) return;
    const VariantRun other{load_variant("opencl"), run.problem, run.method, run.model, run.precision};
    EXPECT_NE(other.executor()->schedule().find("work-groups of 16 lanes"), std::string::npos);
    EXPECT_EQ(differing_bits(run.after(start, 12), other.after(start, 12), run.precision), 0u);
    EXPECT_EQ(differing_bits(run.derivative(start), other.derivative(start), run.precision), 0u);
  });
}
TEST_F(OpenCl, states_have_the_bits_of_packs_in_the_work_groups_of_a_gpu) {
  expect_the_bits_of_a_gpu(packs(), Precision::f64, true);
}
TEST_F(OpenCl, states_have_the_bits_of_packs_in_the_work_groups_of_a_gpu_in_sponges_and_blocks) {
  expect_the_bits_of_a_gpu(packs(), Precision::f64, false);
}
TEST_F(OpenCl, states_have_the_bits_of_packs_in_the_work_groups_of_a_gpu_in_f32) {
  expect_the_bits_of_a_gpu(packs(), Precision::f32, true);
}

TEST_F(OpenCl, rates_of_a_gpu_have_the_bits_of_packs) {
  const DeviceAs gpu("gpu");
  each_run(packs(), [](const VariantRun& run, const State& start) {
    if (run.precision == Precision::f32 || run.problem.name != "plate") return; // derivatives of all terms: above
    const VariantRun other{load_variant("opencl-rhs"), run.problem, run.method, run.model, run.precision};
    EXPECT_EQ(differing_bits(run.after(start, 6), other.after(start, 6), run.precision), 0u);
  });
}

/// A state that is read, written and saved goes to and from a device that does not share the host's memory.
TEST_F(OpenCl, states_have_the_bits_of_packs_on_a_device_with_memory_of_its_own) {
  const DeviceAs device("discrete");
  EXPECT_FALSE(opencl::find_device("", Precision::f32).is_unified);
  each_run(packs(), [&](const VariantRun& run, const State& start) {
    if (run.precision == Precision::f32) return;
    const VariantRun other{load_variant("opencl"), run.problem, run.method, run.model, run.precision, 2};
    EXPECT_EQ(differing_bits(run.after(start, 12), other.after(start, 12), run.precision), 0u);
  });
}

} // namespace
} // namespace dss::test
