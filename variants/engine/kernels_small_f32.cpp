#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<float>& small_f32_kernels(const Terms& need) {
  return find_compiled<SmallPhysics, float, Model::small>(need);
}
} // namespace dss
