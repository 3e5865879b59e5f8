#pragma once
/// The number types that the oracle is compiled for. The module `reference` needs no long double.
#ifdef DSS_WITHOUT_LONG_DOUBLE
#define DSS_EACH_REAL(act) act(float) act(double)
#else
#define DSS_EACH_REAL(act) act(float) act(double) act(long double)
#endif
