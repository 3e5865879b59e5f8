#pragma once
/// X(name, macro): a feature as __builtin_cpu_supports names it, and what a compiler defines where
/// it may use the feature. Newest first: the first one that a CPU lacks is told. CMake
/// (dssbench_variant.cmake) reads this list, too.
// clang-format off
#define DSS_EACH_CPU_FEATURE(X)                                                                    \
  X("avx512f", __AVX512F__)                                                                        \
  X("avx512dq", __AVX512DQ__)                                                                      \
  X("avx512bw", __AVX512BW__)                                                                      \
  X("avx512vl", __AVX512VL__)                                                                      \
  X("avx512cd", __AVX512CD__)                                                                      \
  X("avx512vbmi", __AVX512VBMI__)                                                                  \
  X("avx512ifma", __AVX512IFMA__)                                                                  \
  X("avx512vnni", __AVX512VNNI__)                                                                  \
  X("avx2", __AVX2__)                                                                              \
  X("fma", __FMA__)                                                                                \
  X("bmi2", __BMI2__)                                                                              \
  X("bmi", __BMI__)                                                                                \
  X("avx", __AVX__)                                                                                \
  X("sse4.2", __SSE4_2__)
// clang-format on
