#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<float>& linear_f32_kernels(const Terms& need) {
  return find_compiled<LinearPhysics, float, Model::linear>(need);
}
} // namespace dss
