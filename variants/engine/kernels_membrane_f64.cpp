#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<double>& membrane_f64_kernels(const Terms& need) {
  return find_compiled<MembranePhysics, double, Model::membrane>(need);
}
} // namespace dss
