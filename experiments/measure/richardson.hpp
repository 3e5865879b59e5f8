#pragma once
/// Figures at several spacings, extrapolated to the spacing 0.
#include <vector>

namespace dss {

/// Order p and limit f of figures of the form f + c h^p at three spacings h, the finest last. NaN
/// if no p from 0.1 to 10 fits.
struct Richardson {
  double order = 0, limit = 0;
};
Richardson richardson(const std::vector<double>& spacing, const std::vector<double>& figure);

} // namespace dss
