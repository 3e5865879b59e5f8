/// Counting of executed instructions, on instructions of x86 that are written out.
#include "experiments/measure/ceilings/executed_mix.hpp"
#include "solver/error.hpp"

#include <gtest/gtest.h>

namespace dss {
namespace {

/// Per pack of two doubles: three sums, two products, one load that feeds a product, one store, one
/// move to the stack. Written as instructions, so that no compiler can change their number.
void run_known_instructions(int, const void* in, void* out, std::size_t elements, std::size_t) {
  const double* from = static_cast<const double*>(in);
  double* to = static_cast<double*>(out);
  for (std::size_t e = 0; e + 2 <= elements; e += 2)
    asm volatile("movapd (%0), %%xmm0\n\t"
                 "addpd %%xmm0, %%xmm0\n\t"
                 "addpd %%xmm0, %%xmm0\n\t"
                 "subpd %%xmm0, %%xmm0\n\t"
                 "mulpd (%0), %%xmm0\n\t"
                 "mulpd %%xmm0, %%xmm0\n\t"
                 "movapd %%xmm0, (%1)\n\t"
                 :
                 : "r"(from + e), "r"(to + e)
                 : "xmm0", "memory");
}

TEST(X86, AMixHasTheInstructionsThatWereWritten) {
  const CompiledKernel known{
      "known", Model::axial, Precision::f64, 1, 1, 5, 2, run_known_instructions, 0, true};
  InstructionMix mix;
  try {
    mix = executed_mix(known);
  } catch (const InputError& error) {
    GTEST_SKIP() << error.what();
  }
  EXPECT_EQ(mix.fma, 0);
  EXPECT_EQ(mix.sums, 3);
  EXPECT_EQ(mix.products, 2);
  EXPECT_EQ(mix.shuffles, 0);
  EXPECT_EQ(mix.loads - mix.stack_loads, 2);
  EXPECT_EQ(mix.stores - mix.stack_stores, 1);
}

} // namespace
} // namespace dss
