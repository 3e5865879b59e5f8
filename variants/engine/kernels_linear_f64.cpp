#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<double>& linear_f64_kernels(const Terms& need) {
  return find_compiled<LinearPhysics, double, Model::linear>(need);
}
} // namespace dss
