#pragma once
/// X(name, macro, bit): a feature as /proc/cpuinfo names it, what a compiler defines where it may
/// use the feature, and its bit in AT_HWCAP. Newest first: the first one that a CPU lacks is told.
/// CMake (dssbench_variant.cmake) reads this list, too.
// clang-format off
#define DSS_EACH_CPU_FEATURE(X)                                                                    \
  X("sve", __ARM_FEATURE_SVE, HWCAP_SVE)                                                           \
  X("asimddp", __ARM_FEATURE_DOTPROD, HWCAP_ASIMDDP)                                               \
  X("asimdhp", __ARM_FEATURE_FP16_VECTOR_ARITHMETIC, HWCAP_ASIMDHP)                                \
  X("atomics", __ARM_FEATURE_ATOMICS, HWCAP_ATOMICS)                                               \
  X("asimd", __ARM_NEON, HWCAP_ASIMD)
// clang-format on
