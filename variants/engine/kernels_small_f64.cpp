#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<double>& small_f64_kernels(const Terms& need) {
  return find_compiled<SmallPhysics, double, Model::small>(need);
}
} // namespace dss
