// Peak rates of a device. The host defines REAL (double or float; on CPUs a vector of them),
// SCALAR, and CHAINS: the number of independent sums, which hides the latency of the arithmetic.
#ifdef cl_khr_fp64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

__kernel void triad(__global REAL* a, __global const REAL* b, __global const REAL* c, ulong count) {
  for (ulong i = FIRST; i < LAST; i += STRIDE) a[i] = fma((REAL)(SCALAR)3, c[i], b[i]);
}

__kernel void chains(__global REAL* out, int rounds) {
  const REAL factor = (REAL)(SCALAR)0.999, term = (REAL)(SCALAR)0.001;
  REAL sum[CHAINS];
#pragma unroll
  for (int chain = 0; chain < CHAINS; ++chain)
    sum[chain] = (REAL)(SCALAR)(chain + get_global_id(0));
  for (int round = 0; round < rounds; ++round) {
#pragma unroll
    for (int chain = 0; chain < CHAINS; ++chain) sum[chain] = fma(sum[chain], factor, term);
  }
#pragma unroll
  for (int chain = 1; chain < CHAINS; ++chain) sum[0] += sum[chain];
  out[get_global_id(0)] = sum[0];
}
