#include "experiments/run/model/relative_error.hpp"

#include <algorithm>
#include <limits>

namespace dss {

double relative_error(const Problem& problem, const KindBounds& errors, const KindValues& largest) {
  const KindValues scales = error_scales(problem, largest);
  double most = 0;
  for (std::size_t kind = 0; kind < scales.size(); ++kind)
    most = std::max(most, relative(errors[kind], scales[kind]));
  return most;
}

} // namespace dss
