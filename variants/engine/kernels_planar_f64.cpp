#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<double>& planar_f64_kernels(const Terms& need) {
  return find_compiled<PlanarPhysics, double, Model::planar>(need);
}
} // namespace dss
