#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<double>& spatial_f64_kernels(const Terms& need) {
  return find_compiled<SpatialPhysics, double, Model::spatial>(need);
}
} // namespace dss
