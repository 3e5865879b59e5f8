#include "variants/engine/pressure_table.hpp"

#include "variants/engine/lane_numbers.hpp"
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
PressureLanes<T> PressureTable<T, W>::lanes_of(const FaceKinds<W>& pack) const {
  PressureLanes<T> all{};
  for (std::size_t lane = 0; lane < std::size_t(simd::lanes<T>); ++lane) {
    const Problem& member = *members_[members_.size() > 1 ? lane : 0];
    const auto one = pressure_constants<T>(member.bodies[std::size_t(pack.body)], pack.kinds[lane]);
    set_lane<T>(all, lane, one, sizeof one / sizeof(T));
  }
  return all;
}

template <class T, int W>
void PressureTable<T, W>::finish() {
  kinds_.resize(numbers_.size());
  for (const auto& [pack, number] : numbers_) kinds_[std::size_t(number)] = pack;
  numbers_.clear();
  if constexpr (W == simd::lanes<T>)
    for (const FaceKinds<W>& pack : kinds_) lanes_.push_back(lanes_of(pack));
}

#define DSS_INSTANTIATE(T, W) template class PressureTable<T, W>;
DSS_EACH_PACK(DSS_INSTANTIATE)
#undef DSS_INSTANTIATE
template PressureConstants<double> pressure_constants(const Body&, std::uint8_t);
template PressureConstants<float> pressure_constants(const Body&, std::uint8_t);

} // namespace dss
