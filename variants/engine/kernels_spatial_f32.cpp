#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<float>& spatial_f32_kernels(const Terms& need) {
  return find_compiled<SpatialPhysics, float, Model::spatial>(need);
}
} // namespace dss
