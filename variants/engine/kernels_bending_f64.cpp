#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<double>& bending_f64_kernels(const Terms& need) {
  return find_compiled<BendingPhysics, double, Model::bending>(need);
}
} // namespace dss
