#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<double>& axial_f64_kernels(const Terms& need) {
  return find_compiled<AxialPhysics, double, Model::axial>(need);
}
} // namespace dss
