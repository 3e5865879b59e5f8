#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<float>& bending_f32_kernels(const Terms& need) {
  return find_compiled<BendingPhysics, float, Model::bending>(need);
}
} // namespace dss
