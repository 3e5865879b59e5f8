#include "variants/engine/pressure_table.hpp"

#include "variants/engine/packs.hpp"

namespace dss {

template <class T>
PressureConstants<T> pressure_constants(const Body& body, std::uint8_t kind) {
  if (body.pressures.empty()) return {};
  const ElementPressure& element = body.pressures[kind];
  const double volume = body.edge[0] * body.edge[1] * body.edge[2];
  const auto bending = [&](std::size_t o) { return T(volume * element.bending[o] / 2); };
  return {T(volume * element.volume / 4), bending(0), bending(1), bending(2)};
}

template <class T, int W>
void PressureTable<T, W>::finish() {
  numbers_.finish();
  if constexpr (W == simd::lanes<T>)
    for (const PackKinds<W>& pack : kinds())
      lanes_.push_back(lanes_of<T, PressureLanes<T>>(members_, pack, pressure_constants<T>));
}

#define DSS_INSTANTIATE(T, W) template class PressureTable<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE
template PressureConstants<double> pressure_constants(const Body&, std::uint8_t);
template PressureConstants<float> pressure_constants(const Body&, std::uint8_t);

} // namespace dss
