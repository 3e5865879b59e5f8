#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<float>& planar_f32_kernels(const Terms& need) {
  return find_compiled<PlanarPhysics, float, Model::planar>(need);
}
} // namespace dss
