#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<float>& membrane_f32_kernels(const Terms& need) {
  return find_compiled<MembranePhysics, float, Model::membrane>(need);
}
} // namespace dss
