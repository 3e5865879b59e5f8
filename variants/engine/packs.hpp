#pragma once
/// The packs (numbers, lanes) that the engine is compiled for in this module.
#include "kernels/simd/simd.hpp"

#ifdef DSS_FOR_DEVICES // the vectors of CPU devices; sixteen lanes for GPUs
#define DSS_EACH_PACK(X) X(double, 4) X(double, 8) X(double, 16) X(float, 8) X(float, 16)
#else
#define DSS_EACH_PACK(X) X(double, simd::lanes<double>) X(float, simd::lanes<float>)
#endif
