#include "variants/engine/instantiate.hpp"

namespace dss {
const KernelSet<float>& axial_f32_kernels(const Terms& need) {
  return find_compiled<AxialPhysics, float, Model::axial>(need);
}
} // namespace dss
